// Marks on a few of many ids, and numbers for them, for searches of which each thread has its own. Internal to spatial.
#pragma once

#include <cstdint>
#include <vector>

namespace curvetet::kernel {

/// States 1, 2 and 3 of ids, forgotten all at once: a table with open addressing. A mark costs a few nanoseconds and no
/// memory in proportion to the mesh.
class SmallMarks {
 public:
  /// All states become 0.
  void start() {
    count_ = 0;
    if (++epoch_ < kMostEpochs) return;
    entries_.assign(entries_.size(), {});
    epoch_ = 1;
  }
  std::uint32_t state(std::uint32_t id) const {
    const Entry& entry = entries_[place_of(id)];
    return entry.stamp >> 2U == epoch_ ? entry.stamp & 3U : 0;
  }
  void set(std::uint32_t id, std::uint32_t state) {
    Entry& entry = entries_[place_of(id)];
    const bool fresh = entry.stamp >> 2U != epoch_;
    entry = {id, epoch_ << 2U | state};
    if (fresh && 2 * ++count_ > entries_.size()) grow();
  }
  std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }

 private:
  struct Entry {
    std::uint32_t id = 0, stamp = 0;
  };
  static constexpr std::uint32_t kMostEpochs = 1U << 30U;

  /// Where the id is, or would be.
  std::size_t place_of(std::uint32_t id) const {
    const std::size_t mask = entries_.size() - 1;
    std::size_t at = (id * std::uint64_t{0x9E3779B97F4A7C15} >> 32U) & mask;
    while (entries_[at].stamp >> 2U == epoch_ && entries_[at].id != id) at = (at + 1) & mask;
    return at;
  }
  void grow() {
    std::vector<Entry> old(2 * entries_.size());
    old.swap(entries_);
    for (const Entry& entry : old)
      if (entry.stamp >> 2U == epoch_) entries_[place_of(entry.id)] = entry;
  }

  std::vector<Entry> entries_ = std::vector<Entry>(256);  ///< a power of two
  std::size_t count_ = 0;
  std::uint32_t epoch_ = 1;
};

/// Numbers 0, 1, 2... for ids in the order in which they are asked for, in the same way.
class SmallNumbers {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  /// No id has a number.
  void start() {
    count_ = 0;
    if (++epoch_ != 0) return;
    entries_.assign(entries_.size(), {});
    epoch_ = 1;
  }
  std::uint32_t count() const { return count_; }
  /// kNone if it has none.
  std::uint32_t find(std::uint32_t id) const {
    const Entry& entry = entries_[place_of(id)];
    return entry.epoch == epoch_ ? entry.number : kNone;
  }
  /// Gives it the next number if it has none.
  std::uint32_t number_of(std::uint32_t id) {
    Entry& entry = entries_[place_of(id)];
    if (entry.epoch == epoch_) return entry.number;
    entry = {id, epoch_, count_++};
    if (2 * std::size_t{count_} > entries_.size()) grow();
    return count_ - 1;
  }
  std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }

 private:
  struct Entry {
    std::uint32_t id = 0, epoch = 0, number = 0;
  };
  std::size_t place_of(std::uint32_t id) const {
    const std::size_t mask = entries_.size() - 1;
    std::size_t at = (id * std::uint64_t{0x9E3779B97F4A7C15} >> 32U) & mask;
    while (entries_[at].epoch == epoch_ && entries_[at].id != id) at = (at + 1) & mask;
    return at;
  }
  void grow() {
    std::vector<Entry> old(2 * entries_.size());
    old.swap(entries_);
    for (const Entry& entry : old)
      if (entry.epoch == epoch_) entries_[place_of(entry.id)] = entry;
  }

  std::vector<Entry> entries_ = std::vector<Entry>(256);  ///< a power of two
  std::uint32_t count_ = 0, epoch_ = 1;
};

}  // namespace curvetet::kernel
