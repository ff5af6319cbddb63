#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "python/extension/arrays.hpp"
#include "qddot/model/capabilities.hpp"

namespace qddot::python {

// f and V as C functions of n unknowns: void force(const double* q, double* f, int64_t n) and
// double potential(const double* q, int64_t n). They are called without the GIL.
using CForce = void (*)(const double*, double*, std::int64_t);
using CPotential = double (*)(const double*, std::int64_t);

// Arrays of a fixed shape through which Python callables see the solver's memory. Each is made once
// for a place and reused while nobody else holds it. Callers hold the GIL.
class Views {
 public:
  explicit Views(std::vector<py::ssize_t> shape) : shape_(std::move(shape)) {}

  // An array whose numbers are those at `place`, for one call.
  py::object show(const double* place, bool may_write);
  // Ends the call. Throws std::runtime_error if somebody has kept the array, as its memory is the
  // solver's.
  void take_back(py::object view, const char* callable, const char* argument);
  // Copies the memory of an array that a traceback may hold.
  static void part(const py::object& view);

 private:
  std::vector<py::ssize_t> shape_;
  std::vector<py::object> spare_;
};

// The forces of a user of Python: f, and optionally V and K, as callables; f and V may be C
// functions. An exception of a callable ends the run (see outside()). Callables:
//   force(q, f)    writes f [N], returns nothing or f
//   potential(q)   returns V [J]
//   stiffness(q)   returns K [N/m], n x n and symmetric: dense, or a tuple (data, indices, indptr)
//                  of its sorted columns
// q and f are arrays of `shape` over the solver's memory, q read-only.
//   damping(q)     returns C [N s/m], likewise: f gets -C(q) v
class OwnForces final : public System, public Damping {
 public:
  using Force = std::variant<CForce, py::object>;
  using Potential = std::variant<std::monostate, CPotential, py::object>;

  // `pattern`: the pattern of K; 0 x 0 without a stiffness. `is_linear`: whether K and C are the
  // same everywhere. `damping`: None for none; `damping_pattern` is that of C.
  OwnForces(Vec mass, std::vector<py::ssize_t> shape, Force force, Potential potential,
            py::object stiffness, SymmetricMatrix pattern, bool is_linear, py::object damping,
            SymmetricMatrix damping_pattern);
  ~OwnForces() override;

  bool has_potential() const override { return potential_.index() > 0; }
  double potential(const At& at) const override;
  void force(const At& at, MutableVec f) const override;
  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  void stiffness(const At& at, SymmetricMatrix& k) const override;
  bool stiffness_is_constant() const override { return is_linear_; }
  bool is_conservative() const override { return damping_.is_none(); }

  const Damping* damping() const override { return damping_.is_none() ? nullptr : this; }
  void friction(const At& at, MutableVec f) const override;
  void damping_matrix(const At& at, SymmetricMatrix& c) const override;
  bool damping_is_constant() const override { return is_linear_; }

 private:
  // f of positions alone.
  void elastic_force(const At& at, MutableVec f) const;
  // Fills a matrix with what the callable returns.
  void fill(const py::object& callable, const char* what, const ConstVec& q,
            SymmetricMatrix& matrix) const;
  // Calls the callable with a view of q, and `use` with its result.
  template <class Use>
  void call(const py::object& callable, const char* name, const ConstVec& q, const Use& use) const;

  Force force_;
  Potential potential_;
  py::object stiffness_, damping_;
  SymmetricMatrix pattern_;
  mutable SymmetricMatrix c_;  // scratch, guarded by the GIL
  bool is_linear_;
  mutable Views views_;
};

// The lower triangle with these entries and the whole diagonal, all zero. Throws
// std::invalid_argument for an entry beyond n.
SymmetricMatrix pattern_of(const Indices& rows, const Indices& columns, Index n);

}  // namespace qddot::python
