// Phases of a team: every item once, in any number of blocks, and failures that reach the owner. Sorting and loops in
// blocks on all threads.
#include "base/team.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "base/gather.h"
#include "base/parallel_sort.h"

namespace curvetet {
namespace {

TEST(Team, DoesEachItemOnce) {
  const Context context;
  Team team(context);
  for (const std::size_t n : {0U, 1U, 7U, 64U, 1000U}) {
    for (const std::size_t grain : {1U, 3U, 64U, 5000U}) {
      std::vector<int> done(n, 0);
      team.run(n, grain, [&](std::size_t i, std::size_t worker) {
        ++done[i];
        EXPECT_LT(worker, team.size());
      });
      EXPECT_EQ(done, std::vector<int>(n, 1)) << n << " items by " << grain;
    }
  }
}

TEST(Team, EachPhaseSeesAllOfTheOneBefore) {
  const Context context;
  Team team(context);
  constexpr std::size_t kItems = 50;
  std::vector<std::size_t> value(kItems, 1), sums(kItems, 0);
  std::size_t expected = 1;
  for (int phase = 0; phase < 3000; ++phase) {
    team.run(kItems, 1, [&](std::size_t i, std::size_t) {
      sums[i] = std::accumulate(value.begin(), value.end(), std::size_t{0}) / kItems;
    });
    ++expected;
    team.run(kItems, 2, [&](std::size_t i, std::size_t) { value[i] = sums[i] + 1; });
    ASSERT_EQ(value, std::vector<std::size_t>(kItems, expected)) << "phase " << phase;
  }
}

TEST(Team, AnExceptionOfAnyBlockReachesTheOwner) {
  const Context context;
  Team team(context);
  for (std::size_t fails = 0; fails < 20; ++fails) {
    const auto body = [&](std::size_t i, std::size_t) {
      if (i == fails) throw std::runtime_error("body");
    };
    EXPECT_THROW(team.run(20, 1, body), std::runtime_error);
    std::atomic<int> done = 0;
    team.run(20, 1, [&](std::size_t, std::size_t) { ++done; });
    EXPECT_EQ(done, 20) << "the next phase is as any other";
  }
}

TEST(Team, WakesWhereItSlept) {
  const Context context;
  Team team(context);
  for (int phase = 0; phase < 3; ++phase) {
    std::atomic<int> done = 0;
    team.run(100, 1, [&](std::size_t, std::size_t) { ++done; });
    EXPECT_EQ(done, 100);
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
  }
}

TEST(Team, IsClosedWithoutAPhase) {
  const Context context;
  const Team team(context);
  EXPECT_EQ(team.size(), std::min(worker_count(context), Team::kMostThreads));
}

TEST(ParallelSort, SortsAsOneThreadDoes) {
  const Context context;
  std::vector<std::uint32_t> items(20000);
  std::uint32_t x = 1;
  for (std::uint32_t& item : items) item = (x = x * 1664525U + 1013904223U) >> 8;
  std::vector<std::uint32_t> sorted = items;
  std::sort(sorted.begin(), sorted.end());
  parallel_sort(context, items, std::less<>());
  EXPECT_EQ(items, sorted);
}

TEST(InBlocks, CoversAll) {
  const Context context;
  std::vector<int> seen(1003, 0);
  in_blocks(context, seen.size(), 10, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++seen[i];
  });
  EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
}

}  // namespace
}  // namespace curvetet
