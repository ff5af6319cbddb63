// A square cloth, pinned at the two corners of one side, let go flat and horizontal.
#include "qddot/scene/generators/cloth_grid.hpp"

namespace qddot {

Generator cloth() {
  return {.name = "cloth",
          .summary = "a square cloth on two pinned corners, let go flat and horizontal",
          .parameters = cloth_parameters(),
          .size = cloth_size,
          .draw = draw_cloth};
}

}  // namespace qddot
