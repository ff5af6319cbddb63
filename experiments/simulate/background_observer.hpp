#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "qddot/model/system.hpp"

namespace qddot::simulate {

// Calls `look` with the states of a run, in order, on a thread of its own while the run goes on. So
// the work on them, such as the text of a table, costs the run only a copy of each state. If `look`
// is slower than the run, the run waits.
class BackgroundObserver {
 public:
  explicit BackgroundObserver(std::function<void(const State&)> look);
  // Drops the states that were not yet looked at.
  ~BackgroundObserver();
  BackgroundObserver(const BackgroundObserver&) = delete;
  BackgroundObserver& operator=(const BackgroundObserver&) = delete;

  // Takes a copy. Throws the exception of an earlier look, after which no more states are looked
  // at.
  void see(const State& state);
  // Returns when all states have been looked at; throws as see().
  void finish();

 private:
  // States in order of arrival, and behind them the memory of earlier ones.
  struct Batch {
    std::vector<State> states;
    std::size_t count = 0;
  };

  void run();
  // Hands the gathered states to the thread when it has none left.
  void hand_over();
  void wait(std::unique_lock<std::mutex>& lock);

  std::function<void(const State&)> look_;
  Batch gathered_;  // by the run
  Index size_ = 0;  // in numbers
  Batch at_hand_;   // the thread's, while its count is not zero
  std::exception_ptr error_;
  bool is_over_ = false;
  std::mutex mutex_;  // guards at_hand_, error_ and is_over_
  std::condition_variable changed_;
  std::thread thread_;
};

}  // namespace qddot::simulate
