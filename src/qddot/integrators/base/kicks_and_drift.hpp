#pragma once

#include "qddot/model/beside_force.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot {

// Two kicks and a drift beside the force at their end (see kick_and_drift and
// System::force_beside):
//   w = (v + c0 f/m) + c f/m,   q' = q + h w,   then f' = f(q').
// Parts of q' go from here to the force in a near cache. Refers to all vectors and to M, which must
// outlive this. q' may be q, w may be v, and f' may be f.
class KicksAndDrift final : public BesideForce {
 public:
  struct Sizes {
    double c0, c, h;  // [s]
  };
  KicksAndDrift(const Motion& from, const Sizes& sizes, Vec& q_next, Vec& w)
      : from_(from), sizes_(sizes), q_next_(q_next), w_(w) {}

  // Has the force return |w + late f'/m|^2, in place of 0.
  void see_speed(double late, const Vec& f_next) {
    late_ = late;
    f_next_ = &f_next;
  }

  void before(Index first, Index end) override {
    kick_and_drift(from_, first, end, sizes_.c0, sizes_.c, sizes_.h, q_next_, w_);
  }
  double after(Index first, Index end) override {
    return f_next_ ? squared_norm_of_kicked(w_, first, end, late_, *f_next_, from_.m) : 0;
  }

 private:
  Motion from_;
  Sizes sizes_;
  Vec &q_next_, &w_;
  double late_ = 0;
  const Vec* f_next_ = nullptr;
};

}  // namespace qddot
