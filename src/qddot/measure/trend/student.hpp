#pragma once

namespace qddot::inline measure {

// The 97.5 % quantile of Student's t with `freedom` > 0 degrees of freedom, which is half the width
// of its 95 % interval.
double student_half_width(double freedom);

}  // namespace qddot::inline measure
