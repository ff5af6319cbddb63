#pragma once

namespace qddot::measure {

// Half the width of the interval that holds 95 % of Student's t with `freedom` > 0 degrees of
// freedom: its 97.5 % quantile.
double student_half_width(double freedom);

}  // namespace qddot::measure
