// Spawned, not forked: a fork of a process with threads may not call the CAD kernel. A process group for each child, so
// that a Ctrl-C is its parent's to pass on, and what it started can be ended with it. A parent that is killed cannot
// end its children, and posix_spawn cannot tell them to watch it: they do so themselves.
#include "base/child_program.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#ifdef __linux__
#include <sys/prctl.h>
#endif

extern char** environ;

namespace curvetet {

namespace {

constexpr const char* kParent = "CURVETET_PARENT";

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size() + 1);
  for (std::string& text : texts) result.push_back(text.data());
  return result;
}

}  // namespace

ChildProgram::ChildProgram(const std::string& program, std::vector<std::string> arguments, const std::string& log,
                           const std::vector<std::string>& variables) {
  std::vector<char*> argv = pointers(arguments);
  argv.push_back(nullptr);
  std::vector<std::string> added = variables;
  std::vector<char*> environment = pointers(added);
  for (char** variable = environ; variable != nullptr && *variable != nullptr; ++variable)
    environment.push_back(*variable);
  environment.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  started_ = posix_spawn(&id_, program.c_str(), &actions, &attributes, argv.data(), environment.data()) == 0;
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
}

ChildProgram::~ChildProgram() {
  if (started_ && !finished_) kill();
}

bool ChildProgram::poll() {
  if (finished_) return true;
  const pid_t ended = waitpid(id_, &status_, WNOHANG);
  if (ended == id_ || (ended < 0 && errno == ECHILD)) finished_ = true;
  return finished_;
}

void ChildProgram::terminate() const {
  if (started_ && !finished_) ::kill(-id_, SIGTERM);
}

void ChildProgram::kill() {
  ::kill(-id_, SIGKILL);
  while (!finished_ && waitpid(id_, &status_, 0) < 0 && errno == EINTR) {
  }
  finished_ = true;
}

int ChildProgram::exit_code() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1; }

int ChildProgram::signal() const { return WIFSIGNALED(status_) ? WTERMSIG(status_) : 0; }

void end_with_parent() {
  const char* parent = std::getenv(kParent);
  if (parent == nullptr) return;
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  const pid_t asked = std::atoi(parent);
  unsetenv(kParent);
  if (getppid() != asked) std::_Exit(EXIT_FAILURE);  // it has ended already
}

std::string end_with_parent_variable() { return std::string(kParent) + "=" + std::to_string(getpid()); }

}  // namespace curvetet
