// A program run in the background, with all that it starts, in a process group of its own.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace curvetet {

/// The child reads nothing and says everything to a log file. It, and what it started in its own group, is killed when
/// it goes out of scope unfinished. To be made and polled by one thread.
class ChildProgram {
 public:
  /// Adds `variables` (NAME=value) to the environment.
  ChildProgram(const std::string& program, std::vector<std::string> arguments, const std::string& log,
               const std::vector<std::string>& variables);
  ~ChildProgram();
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  bool started() const { return started_; }
  /// True once it has ended.
  bool poll();
  void terminate() const;  ///< asks it to end
  void kill();             ///< ends it, and waits for that
  int exit_code() const;   ///< -1 if a signal ended it
  int signal() const;      ///< that ended it, or 0

 private:
  pid_t id_ = 0;
  int status_ = 0;
  bool started_ = false, finished_ = false;
};

/// To be called at the start of a program that may be a child: if its parent asked for it by the variable, it is killed
/// when the parent ends, however that may be.
void end_with_parent();
/// The variable by which a parent asks, with its process id as value.
std::string end_with_parent_variable();

}  // namespace curvetet
