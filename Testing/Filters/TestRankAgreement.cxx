// How ranks agree on what happened to their work, on threads of this process that stand for them.

#include "shared/ranks.h"

#include "base/abort.h"
#include "base/errors.h"

#include "vtkCommunicator.h"
#include "vtkDummyController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <new>
#include <thread>

namespace
{

using rockfall::filters::Ranks;

/// What ranks send each other.
struct Post
{
  std::mutex mutex;
  std::condition_variable arrived;
  std::map<std::array<int, 3>, std::deque<std::vector<char>>> letters; // from, to, tag
  int sent = 0;
};

/// A message that does not come within this time never will.
constexpr std::chrono::seconds patience{ 5 };

class ThreadCommunicator : public vtkCommunicator
{
public:
  static ThreadCommunicator* New() { VTK_STANDARD_NEW_BODY(ThreadCommunicator); }
  void Place(Post& post, int rank, int ranks)
  {
    this->Letters = &post;
    this->MaximumNumberOfProcesses = this->NumberOfProcesses = ranks;
    this->LocalProcessId = rank;
  }
  int SendVoidArray(const void* data, vtkIdType length, int type, int to, int tag) override
  {
    const char* bytes = static_cast<const char*>(data);
    const std::lock_guard<std::mutex> lock(this->Letters->mutex);
    this->Letters->letters[{ this->LocalProcessId, to, tag }].emplace_back(
      bytes, bytes + length * SizeOf(type));
    ++this->Letters->sent;
    this->Letters->arrived.notify_all();
    return 1;
  }
  int ReceiveVoidArray(void* data, vtkIdType length, int type, int from, int tag) override
  {
    std::unique_lock<std::mutex> lock(this->Letters->mutex);
    auto& letters = this->Letters->letters[{ from, this->LocalProcessId, tag }];
    if (!this->Letters->arrived.wait_for(lock, patience, [&] { return !letters.empty(); }))
    {
      throw std::runtime_error("no message from rank " + std::to_string(from));
    }
    const std::vector<char> letter = std::move(letters.front());
    letters.pop_front();
    if (letter.size() > std::size_t(length) * std::size_t(SizeOf(type)))
    {
      throw std::runtime_error("a message of another kind from rank " + std::to_string(from));
    }
    std::memcpy(data, letter.data(), letter.size());
    return 1;
  }

private:
  static int SizeOf(int type)
  {
    switch (type)
    {
      case VTK_DOUBLE:
      case VTK_LONG:
      case VTK_LONG_LONG:
        return 8;
      case VTK_INT:
        return 4;
      default: // bytes
        return 1;
    }
  }
  Post* Letters = nullptr;
};

/// What came out on a rank: well, aborted, or the text of an error, and what it gathers after that.
struct Outcome
{
  std::string text;
  std::vector<int> after;

  bool operator==(const Outcome&) const = default;
};

/// Each rank does its own work and then gathers a number, as the next step of a run would.
std::vector<Outcome> outcomes(
  const std::vector<std::function<void(const Ranks&)>>& works, int* sent = nullptr)
{
  Post post;
  std::vector<Outcome> all(works.size());
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < works.size(); ++k)
  {
    threads.emplace_back(
      [&, k]
      {
        vtkNew<ThreadCommunicator> communicator;
        communicator->Place(post, int(k), int(works.size()));
        vtkNew<vtkDummyController> controller;
        controller->SetCommunicator(communicator);
        const Ranks ranks(controller);
        try
        {
          try
          {
            works[k](ranks);
            all[k].text = "well";
          }
          catch (const rockfall::Aborted&)
          {
            all[k].text = "aborted";
          }
          catch (const rockfall::Error& error)
          {
            all[k].text = error.what();
          }
          all[k].after = ranks.gather(int(10 + k));
        }
        catch (const std::exception& error)
        {
          all[k].text = std::string("deadlock: ") + error.what();
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  if (sent)
  {
    *sent = post.sent;
  }
  return all;
}

void well(const Ranks& ranks)
{
  ranks.together([] {}, "no memory");
}
void fails(const Ranks& ranks)
{
  ranks.together(
    [&] { throw rockfall::Error("rank " + std::to_string(ranks.rank())); }, "no memory");
}
void isFull(const Ranks& ranks)
{
  ranks.together([] { throw std::bad_alloc(); }, "no memory");
}
void givesUp(const Ranks& ranks)
{
  ranks.together([] { throw rockfall::Aborted(); }, "no memory");
}
void agreesWell(const Ranks& ranks)
{
  ranks.agree("");
}
void agreesOnAProblem(const Ranks& ranks)
{
  ranks.agree("a problem of rank " + std::to_string(ranks.rank()));
}

using Works = std::vector<std::function<void(const Ranks&)>>;

} // namespace

TEST(RankAgreement, TheWorstOfAnyRankIsThatOfAll)
{
  const std::vector<std::pair<Works, std::string>> cases = {
    { { well, well, well }, "well" },
    { { well, fails, well }, "rank 1" },
    { { well, fails, fails }, "rank 1" },
    { { isFull, fails, well }, "no memory" },
    { { fails, givesUp, well }, "aborted" },
    { { well, well, givesUp }, "aborted" },
  };
  for (const auto& [works, text] : cases)
  {
    const Outcome expected{ text, { 10, 11, 12 } };
    EXPECT_EQ(outcomes(works), std::vector<Outcome>(3, expected)) << text;
  }
}

// One side agrees on a problem that it knows, the other on how its work went.
TEST(RankAgreement, WorkAndKnownProblemsSendTheSameMessages)
{
  const std::vector<std::pair<Works, std::string>> cases = {
    { { agreesWell, well }, "well" },
    { { agreesOnAProblem, well }, "a problem of rank 0" },
    { { well, agreesOnAProblem }, "a problem of rank 1" },
    { { agreesWell, fails }, "rank 1" },
    { { agreesOnAProblem, givesUp }, "aborted" },
    { { givesUp, agreesWell }, "aborted" },
  };
  for (const auto& [works, text] : cases)
  {
    const Outcome expected{ text, { 10, 11 } };
    EXPECT_EQ(outcomes(works), std::vector<Outcome>(2, expected)) << text;
  }
}

TEST(RankAgreement, WorkThatGoesWellTakesOneGather)
{
  int agreed = 0, gathered = 0;
  outcomes({ well, well, well, well }, &agreed);
  outcomes(
    { [](const Ranks& ranks) { ranks.gather(0); }, [](const Ranks& ranks) { ranks.gather(0); },
      [](const Ranks& ranks) { ranks.gather(0); }, [](const Ranks& ranks) { ranks.gather(0); } },
    &gathered);
  EXPECT_EQ(agreed, gathered);
}

// The ranks that send bytes agree with the one that has no room for them.
TEST(RankAgreement, CollectedBytesAreThoseOfEachRank)
{
  std::vector<std::vector<char>> collected;
  const auto collect = [&](const Ranks& ranks)
  {
    auto all = ranks.collect(std::vector<char>(std::size_t(1 + ranks.rank()), 'a'), "no memory");
    if (ranks.rank() == 0)
    {
      collected = all;
    }
    else
    {
      EXPECT_TRUE(all.empty());
    }
  };
  const Outcome expected{ "well", { 10, 11, 12 } };
  EXPECT_EQ(outcomes({ collect, collect, collect }), std::vector<Outcome>(3, expected));
  ASSERT_EQ(collected.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k)
  {
    EXPECT_EQ(collected[k], std::vector<char>(k + 1, 'a'));
  }
}
