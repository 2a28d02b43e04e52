#include "terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>

namespace curvetet::cli {

namespace {

// A signal handler can reach nothing but a global.
std::atomic<Context*> interrupted_context{nullptr};
static_assert(std::atomic<Context*>::is_always_lock_free);

extern "C" void cancel_run(int) {
  if (Context* context = interrupted_context.load()) context->cancel();
}

void on_signals(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  // The first signal restores the default, so that a second one ends a program that does not listen.
  action.sa_flags = handler == SIG_DFL ? 0 : static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

}  // namespace

Terminal::Terminal(Volume volume)
    : volume_(volume), on_terminal_(isatty(STDERR_FILENO) == 1), begin_(std::chrono::steady_clock::now()) {}

void Terminal::attach(Context& context) {
  context.on_log = [this](LogLevel level, std::string_view message) { show_log(level, message); };
  if (volume_ != Volume::quiet) {
    context.on_progress = [this](std::string_view stage, double fraction) { show_progress(stage, fraction); };
  }
}

void Terminal::show_progress(std::string_view stage, double fraction) {
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  const bool new_stage = stage_ != stage;
  if (!new_stage && (!on_terminal_ || now - last_shown_ < std::chrono::milliseconds(100))) return;
  stage_ = stage;
  last_shown_ = now;
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  if (!on_terminal_) {
    fmt::print(stderr, "curvetet: {:3.0f} % {:.1f} s {}\n", 100 * fraction, seconds, stage);
    return;
  }
  constexpr int kWidth = 30;
  const auto done = static_cast<std::size_t>(fraction * kWidth);
  fmt::print(stderr, "\r[{:-<{}}] {:3.0f} % {:6.1f} s  {}\x1b[K", std::string(done, '#'), kWidth, 100 * fraction,
             seconds, stage);
  std::fflush(stderr);
  bar_shown_ = true;
}

void Terminal::clear_bar() {
  if (bar_shown_) fmt::print(stderr, "\r\x1b[K");
  bar_shown_ = false;
}

void Terminal::show_log(LogLevel level, std::string_view message) {
  const LogLevel least = volume_ == Volume::quiet    ? LogLevel::error
                         : volume_ == Volume::normal ? LogLevel::info
                                                     : LogLevel::debug;
  if (level < least) return;
  constexpr const char* kPrefix[] = {"", "", "warning: ", "error: "};
  const std::lock_guard lock(mutex_);
  clear_bar();
  fmt::print(stderr, "curvetet: {}{}\n", kPrefix[static_cast<int>(level)], message);
}

CancelOnSignal::CancelOnSignal(Context& context) {
  interrupted_context.store(&context);
  on_signals(cancel_run);
}

CancelOnSignal::~CancelOnSignal() {
  on_signals(SIG_DFL);
  interrupted_context.store(nullptr);
}

int show_error(const Error& error) {
  fmt::print(stderr, "curvetet: error: {} [{}]\n", error.message, name(error.code));
  if (!error.entities.empty()) fmt::print(stderr, "  entities: {}\n", fmt::join(error.entities, ", "));
  if (error.where)
    fmt::print(stderr, "  at: ({:.6g}, {:.6g}, {:.6g})\n", error.where->x, error.where->y, error.where->z);
  if (!error.hint.empty()) fmt::print(stderr, "  hint: {}\n", error.hint);
  return exit_code(error.code);
}

}  // namespace curvetet::cli
