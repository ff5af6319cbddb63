#pragma once

#include <algorithm>
#include <atomic>

namespace qddot {

// One of the threads that walk through the same code together and share its loops, as it sees the
// team; or a thread by itself, for which all of this is plain loops.
class Team {
 public:
  Team() = default;
  // `tickets`: one for all of the team's threads, zero before they start.
  Team(int threads, std::atomic<int>& tickets) : threads_(threads), tickets_(&tickets) {}

  bool alone() const { return threads_ == 1; }

  // work(i) for i = 0, ..., count - 1, each by whichever thread is free. All threads must come
  // here; none leaves before all is done.
  template <class Work>
  void share(int count, const Work& work) {
    if (alone()) {
      for (int i = 0; i < count; ++i) work(i);
      return;
    }
    // Every thread draws one ticket too many.
    for (int i; (i = tickets_->fetch_add(1, std::memory_order_relaxed) - first_) < count;) work(i);
    first_ += count + threads_;
#pragma omp barrier
  }

  // work(from, end) for parts of [0, count) that begin at multiples of `part`; all at once for a
  // thread alone.
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
  std::atomic<int>* tickets_ = nullptr;
  int first_ = 0;  // the ticket of the next loop's first turn
};

}  // namespace qddot
