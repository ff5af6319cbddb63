// Our f for callers that take a C function, as Python's ctypes: a scene file's forces over the
// coordinates of its free nodes.
#include <exception>
#include <string>

#include "qddot/scene/model.hpp"
#include "qddot/scene/scene_file.hpp"

namespace {

struct Forces {
  explicit Forces(const std::string& path)
      : scene(qddot::load_scene(path), qddot::Reductions::only({qddot::Reduction::pins})),
        per_mass(scene.system().mass().cwiseInverse()),
        q(per_mass.size()),
        f(per_mass.size()) {}

  qddot::Model scene;
  qddot::Vec per_mass, q, f;
};

}  // namespace

extern "C" {

// The forces of that scene file, to be kept for the process; nullptr where it is none.
void* qddot_forces(const char* path) {
  try {
    return new Forces(path);
  } catch (const std::exception&) {
    return nullptr;
  }
}

// a = M^-1 f(q) [m/s^2]; q, a: dimension x free nodes.
void qddot_acceleration(void* forces, const double* q, double* a) {
  auto& own = *static_cast<Forces*>(forces);
  own.q = qddot::Vec::Map(q, own.q.size());
  own.scene.system().force(own.q, own.f);
  qddot::Vec::Map(a, own.f.size()) = own.per_mass.cwiseProduct(own.f);
}
}
