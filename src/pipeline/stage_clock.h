// Times and memory of the stages, for the report; and progress, from a table of weights.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "base/context.h"
#include "base/memory.h"
#include "curvetet/report.h"

namespace curvetet {

class StageClock {
 public:
  explicit StageClock(Context& context) : context_(&context) {}

  /// What stages call the whole run is from now on the part `share` of it that begins at `begin`.
  void set_span(double begin, double share) {
    span_begin_ = begin;
    span_share_ = share;
  }

  /// Ends the running stage and starts the next; `progress` and `end` are the shares of the whole run done when it
  /// starts and ends.
  void start(std::string_view stage, double progress, double end) {
    stop();
    stage_ = stage;
    begin_ = std::chrono::steady_clock::now();
    context_->progress(stage, span_begin_ + span_share_ * progress, span_begin_ + span_share_ * end);
  }
  void stop() {
    if (stage_.empty()) return;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    for (StageTime& t : times_)
      if (t.stage == stage_) {
        t.seconds += seconds;
        t.bytes = std::max(t.bytes, resident_memory());
        stage_.clear();
        return;
      }
    times_.push_back({stage_, seconds, resident_memory()});
    stage_.clear();
  }
  const std::vector<StageTime>& times() const { return times_; }

 private:
  Context* context_;
  std::string stage_;
  double span_begin_ = 0, span_share_ = 1;
  std::chrono::steady_clock::time_point begin_;
  std::vector<StageTime> times_;
};

}  // namespace curvetet
