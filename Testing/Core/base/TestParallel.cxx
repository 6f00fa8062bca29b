// Loops that threads share out: each turn once, done on return, whoever helps.

#include "base/parallel.h"
#include "form.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <random>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace rockfall;
using rockfall::testing::someOf;

namespace
{

const int kRounds = someOf(400, 10); // under ThreadSanitizer each takes twenty times as long

/// work() in an arena of `threads`, whatever the machine has.
template <class Work>
void withThreads(int threads, Work&& work)
{
  const tbb::global_control allow(
    tbb::global_control::max_allowed_parallelism, std::size_t(threads));
  tbb::task_arena arena(threads);
  arena.execute(work);
}

/// Counts its turns, with loops within loops `levels` deep.
void countTurns(
  int levels, std::size_t count, std::size_t grain, std::vector<std::atomic<int>>& turns)
{
  std::atomic<std::size_t> done = 0;
  forEach(count, grain,
    [&](std::size_t i)
    {
      if (levels == 1)
      {
        ++turns[i];
      }
      else
      {
        std::vector<std::atomic<int>> inner(7 + i % 5);
        countTurns(levels - 1, inner.size(), 1 + i % 3, inner);
        int all = 0;
        for (const std::atomic<int>& n : inner)
        {
          all += n == 1;
        }
        turns[i] += all == int(inner.size());
      }
      ++done;
    });
  EXPECT_EQ(done, count); // when it returns, all is done
}

} // namespace

TEST(Parallel, EachTurnIsTakenOnce)
{
  std::mt19937_64 random(3);
  for (const int threads : { 1, 2, 3, 5 })
  {
    withThreads(threads,
      [&]
      {
        for (int k = 0; k < kRounds; ++k)
        {
          const std::size_t count = random() % 60, grain = 1 + random() % 9;
          std::vector<std::atomic<int>> turns(count);
          countTurns(1 + int(random() % 3), count, grain, turns);
          for (const std::atomic<int>& n : turns)
          {
            ASSERT_EQ(n, 1);
          }
        }
      });
  }
}

TEST(Parallel, ShortLoopsAreSharedOut)
{
  // Other threads come as soon as they are awake; that they do shows in whose turns these are.
  withThreads(3,
    []
    {
      std::set<std::thread::id> seen;
      const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
      while (seen.size() < 3 && std::chrono::steady_clock::now() < end)
      {
        std::vector<std::thread::id> whose(64);
        forEach(whose.size(), 1,
          [&](std::size_t i)
          {
            whose[i] = std::this_thread::get_id();
            std::this_thread::yield();
          });
        seen.insert(whose.begin(), whose.end());
      }
      EXPECT_EQ(seen.size(), 3u);
    });
}

TEST(Parallel, AThreadFinishesItsTurnBeforeTheNextOfTheSameLoop)
{
  // What a turn keeps by thread must not be taken by another turn while it waits for loops of its
  // own.
  thread_local int inside = 0;
  withThreads(4,
    []
    {
      std::atomic<int> mixed = 0;
      for (int k = 0; k < kRounds / 10; ++k)
      {
        forEach(12, 1,
          [&](std::size_t)
          {
            mixed += ++inside != 1;
            forEach(40, 1, [](std::size_t) { std::this_thread::yield(); });
            mixed += inside-- != 1;
          });
      }
      EXPECT_EQ(mixed, 0);
    });
}

TEST(Parallel, WhatWorkThrowsComesOut)
{
  for (const int threads : { 1, 4 })
  {
    withThreads(threads,
      [&]
      {
        const auto fails = [](std::size_t bad)
        {
          forEach(100, 3,
            [&](std::size_t i)
            {
              if (i == bad)
              {
                throw std::runtime_error("turn " + std::to_string(i));
              }
            });
        };
        for (std::size_t bad = 0; bad < 100; ++bad)
        {
          try
          {
            fails(bad);
            ADD_FAILURE() << "nothing thrown at " << bad;
          }
          catch (const std::runtime_error& error)
          {
            EXPECT_EQ(error.what(), "turn " + std::to_string(bad));
          }
          std::vector<std::atomic<int>> turns(50);
          countTurns(2, turns.size(), 1, turns); // the next one is whole
          for (const std::atomic<int>& n : turns)
          {
            ASSERT_EQ(n, 1);
          }
        }
      });
  }
}
