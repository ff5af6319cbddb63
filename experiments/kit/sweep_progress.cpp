#include "experiments/kit/sweep_progress.hpp"

#include <utility>

#include <fmt/format.h>

namespace qddot::inline kit {

SweepProgress::SweepProgress(std::vector<const Method*> methods, std::optional<SweepBound> bound,
                             std::string prefix, Progress& shown)
    : methods_(std::move(methods)),
      bound_(std::move(bound)),
      prefix_(std::move(prefix)),
      shown_(shown),
      begun_(shown.now()) {
  shown_.begin(methods_.size());
}

SweepProgress::Recall SweepProgress::seen(Recall recall) {
  return [this, recall = std::move(recall)](const Method& method, double value,
                                            const Effort::Take& take) {
    shown_.left_at_most(left());
    shown_.now_at(fmt::format("{}{} {} = {:.3g}", prefix_, method.name,
                              method.knob == Knob::step_size ? "h" : "rtol", value));
    const double before = shown_.now();
    Point point = recall(method, value, take);
    seconds_ = shown_.now() - before;
    return point;
  };
}

void SweepProgress::take(const Point& point) {
  ++points_;
  if (bound_) bound_->learn(point, seconds_);
  seconds_ = 0;
}

void SweepProgress::finish() {
  const std::string name = methods_[at_]->name;
  ++at_;
  points_ = 0;
  begun_ = shown_.now();
  shown_.left_at_most(left());
  shown_.finish(fmt::format("{}{} is done", prefix_, name));
}

std::optional<double> SweepProgress::left() const {
  if (!bound_) return {};
  double seconds = 0;
  for (std::size_t i = at_; i < methods_.size(); ++i) {
    seconds += i == at_ ? bound_->left(*methods_[i], points_, shown_.now() - begun_)
                        : bound_->whole(*methods_[i]);
  }
  return seconds;
}

}  // namespace qddot::inline kit
