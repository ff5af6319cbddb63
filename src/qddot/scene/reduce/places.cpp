#include "qddot/scene/reduce/places.hpp"

#include <cmath>
#include <numeric>

namespace qddot::reduce {

Places::Places(const std::vector<Eigen::Vector3d>& x) : x_(x), order_(x.size()) {
  double high = -INFINITY;
  low_ = INFINITY;
  for (const Eigen::Vector3d& point : x) {
    low_ = std::min(low_, key(point));
    high = std::max(high, key(point));
  }
  last_bucket_ = std::max(0.0, static_cast<double>(x.size()) - 1);
  const double fine = last_bucket_ / (high - low_);
  if (std::isfinite(fine)) buckets_a_metre_ = fine;  // else all are in the first bucket

  // A counting sort by buckets, then each bucket by key.
  begin_.assign(static_cast<std::size_t>(last_bucket_) + 2, 0);
  for (const Eigen::Vector3d& point : x) ++begin_[bucket(key(point)) + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (int i = 0; i < std::ssize(x); ++i) {
    const double own = key(x[static_cast<std::size_t>(i)]);
    order_[static_cast<std::size_t>(next[bucket(own)]++)] = {own, i};
  }
  for (std::size_t b = 0; b + 1 < begin_.size(); ++b) {
    const auto begin = order_.begin() + begin_[b], end = order_.begin() + begin_[b + 1];
    const auto is_before = [](const Entry& a, const Entry& c) { return a.key < c.key; };
    if (!std::is_sorted(begin, end, is_before)) std::stable_sort(begin, end, is_before);
  }
}

bool Places::any_shared(double tolerance) const {
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const Eigen::Vector3d& own = x_[static_cast<std::size_t>(order_[k].point)];
    for (std::size_t other = k + 1;
         other < order_.size() && order_[other].key <= order_[k].key + 2 * tolerance; ++other) {
      if ((x_[static_cast<std::size_t>(order_[other].point)] - own).norm() <= tolerance)
        return true;
    }
  }
  return false;
}

}  // namespace qddot::reduce
