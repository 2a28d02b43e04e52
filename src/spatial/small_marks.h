// Tables of a few of many ids, for searches of which each thread has its own. Internal to spatial.
#pragma once

#include <cstdint>
#include <vector>

namespace curvetet::kernel {

/// Values by key, forgotten all at once: open addressing. An access costs a few nanoseconds, and there is no memory in
/// proportion to the mesh.
template <class Key, class Value>
class SmallTable {
 public:
  /// No key has a value.
  void start() {
    count_ = 0;
    if (++epoch_ != 0) return;
    entries_.assign(entries_.size(), {});
    epoch_ = 1;
  }
  std::size_t size() const { return count_; }
  /// Null if it has none.
  const Value* find(Key key) const {
    const Entry& entry = entries_[place_of(key)];
    return entry.epoch == epoch_ ? &entry.value : nullptr;
  }
  /// The key's value, `value` if it had none; until the next insertion.
  Value& insert(Key key, Value value) {
    Entry* entry = &entries_[place_of(key)];
    if (entry->epoch == epoch_) return entry->value;
    if (2 * ++count_ > entries_.size()) {
      grow();
      entry = &entries_[place_of(key)];
    }
    *entry = {key, epoch_, value};
    return entry->value;
  }
  std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }

 private:
  struct Entry {
    Key key{};
    std::uint32_t epoch = 0;
    Value value{};
  };
  /// Where the key is, or would be.
  std::size_t place_of(Key key) const {
    const std::size_t mask = entries_.size() - 1;
    std::size_t at = (key * std::uint64_t{0x9E3779B97F4A7C15} >> 32U) & mask;
    while (entries_[at].epoch == epoch_ && entries_[at].key != key) at = (at + 1) & mask;
    return at;
  }
  void grow() {
    std::vector<Entry> old(2 * entries_.size());
    old.swap(entries_);
    for (const Entry& entry : old)
      if (entry.epoch == epoch_) entries_[place_of(entry.key)] = entry;
  }

  std::vector<Entry> entries_ = std::vector<Entry>(256);  ///< a power of two
  std::size_t count_ = 0;
  std::uint32_t epoch_ = 1;
};

/// States of ids, 0 at first.
class SmallMarks {
 public:
  void start() { table_.start(); }
  std::uint32_t state(std::uint32_t id) const {
    const std::uint32_t* const found = table_.find(id);
    return found != nullptr ? *found : 0;
  }
  void set(std::uint32_t id, std::uint32_t state) { table_.insert(id, state) = state; }
  std::size_t bytes() const { return table_.bytes(); }

 private:
  SmallTable<std::uint32_t, std::uint32_t> table_;
};

/// Numbers 0, 1, 2... for ids in the order in which they are asked for.
class SmallNumbers {
 public:
  void start() { table_.start(); }
  std::uint32_t count() const { return static_cast<std::uint32_t>(table_.size()); }
  bool contains(std::uint32_t id) const { return table_.find(id) != nullptr; }
  /// The next number if it has none.
  std::uint32_t number_of(std::uint32_t id) { return table_.insert(id, count()); }
  std::size_t bytes() const { return table_.bytes(); }

 private:
  SmallTable<std::uint32_t, std::uint32_t> table_;
};

}  // namespace curvetet::kernel
