#pragma once

#include "experiments/advice/true_motion.hpp"
#include "qddot/integrators/method.hpp"
#include "qddot/measure/motion/error.hpp"

namespace qddot::judged_advice {

// A case is well posed if the effect of rounding is at most this part of the accuracy.
constexpr double well_posed = 0.1;

// A hard case with its true motion, against which runs are measured: that of all nodes as drawn, by
// extrapolation in extended precision (PlainMotion).
class JudgedMotion {
 public:
  // Borrows the case. Only the true motion may be asked for if it is not known.
  explicit JudgedMotion(const HardCase& hard);

  const Model& model() const { return model_; }
  const TrueMotion& truth() const { return truth_; }
  const Scales& scales() const { return scales_; }
  // The effect of one rounding of the start, and of the tolerance of the true motion, on the error
  // that is asked for: the distance of two true motions.
  double conditioning() const { return conditioning_; }
  bool is_well_posed() const { return conditioning_ <= well_posed * hard_.accuracy; }
  // The error of dprkn12 at its finest tolerance; infinite for a system with massless nodes.
  double fine_error() const { return fine_error_; }
  // The states of that run at other times, as far as it goes; for systems without massless nodes.
  std::vector<State> fine_path(const std::vector<double>& times) const;
  // The error of a run that is asked for, at the times of the true motion; infinite if it did not
  // reach the end, zero if nothing is left to be integrated.
  double error_of(const Method& method, double value) const;

 private:
  const HardCase& hard_;
  Model model_;
  TrueMotion truth_;
  Scales scales_;
  double energy_ = 0;  // [J], of the true motion
  double conditioning_ = 0, fine_error_ = 0;
};

}  // namespace qddot::judged_advice
