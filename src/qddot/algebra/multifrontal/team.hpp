#pragma once

#include <algorithm>
#include <atomic>

namespace qddot::multifrontal {

// The state that the threads of a team share.
class Barrier {
 public:
  explicit Barrier(int threads) : threads_(threads) {}

  int threads() const { return threads_; }
  // Returns 0, 1, 2, ..., each number once.
  int draw() { return next_.fetch_add(1, std::memory_order_relaxed); }

  // Returns when all threads have come. A loop of waiting would keep the processor from a thread
  // that other programs have interrupted. So the others sleep after some microseconds.
  void wait() {
    const int round = round_.load();
    if (come_.fetch_add(1) + 1 == threads_) {
      come_.store(0);
      round_.store(round + 1);
      round_.notify_all();
      return;
    }
    for (int i = 0; i < 20000 && round_.load() == round;) ++i;
    round_.wait(round);
  }

 private:
  const int threads_;
  alignas(64) std::atomic<int> next_ = 0;
  alignas(64) std::atomic<int> come_ = 0;
  alignas(64) std::atomic<int> round_ = 0;
};

// One thread's view of a team of threads that run the same code together and share its loops. For a
// single thread, all of this is plain loops.
class Team {
 public:
  Team() = default;
  explicit Team(Barrier& meeting) : threads_(meeting.threads()), meeting_(&meeting) {}

  bool alone() const { return threads_ == 1; }

  // Runs work(i) for i = 0, ..., count - 1, each on any free thread. All threads must call this;
  // none returns before all is done.
  template <class Work>
  void share(int count, const Work& work) {
    if (alone()) {
      for (int i = 0; i < count; ++i) work(i);
      return;
    }
    for (int i = meeting_->draw() - first_; i < count; i = meeting_->draw() - first_) work(i);
    first_ += count + threads_;  // every thread has drawn one number too many
    meeting_->wait();
  }

  // Runs work(from, end) for parts of [0, count) that begin at multiples of `part`; a single thread
  // takes all at once.
  template <class Work>
  void share_parts(int count, int part, const Work& work) {
    if (alone()) {
      work(0, count);
    } else {
      share((count + part - 1) / part,
            [&](int i) { work(i * part, std::min((i + 1) * part, count)); });
    }
  }

 private:
  int threads_ = 1;
  Barrier* meeting_ = nullptr;
  int first_ = 0;  // the number of the next loop's first turn
};

}  // namespace qddot::multifrontal
