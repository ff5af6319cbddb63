#include "python/extension/own_forces.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "python/extension/outside.hpp"

namespace qddot::python {
namespace {

// More places than a method has vectors q and f for forces.
constexpr std::size_t most_spare = 64;

// Calls Python with the GIL, and stores the exception that it raises.
template <class Work>
void inside(const Work& work) {
  try {
    const py::gil_scoped_acquire acquired;
    work();
  } catch (...) {
    remember(std::current_exception());
    throw;
  }
}

// Writes entries (i, j) of K to their places in the pattern.
class Filling {
 public:
  Filling(SymmetricMatrix& k, const char* what) : k_(k), what_(what) { k.coeffs().setZero(); }

  // Starts a column, whose rows ascend.
  void begin(Index column) {
    column_ = column;
    at_ = k_.outerIndexPtr()[column];
  }
  void put(Index row, double value) {
    const Index end = k_.outerIndexPtr()[column_ + 1];
    while (at_ < end && k_.innerIndexPtr()[at_] < row) ++at_;
    if (at_ < end && k_.innerIndexPtr()[at_] == row) {
      k_.valuePtr()[at_] = value;
    } else if (value != 0) {
      throw std::invalid_argument(fmt::format(
          "{}: entry ({}, {}) is {:g}, and the pattern has none there, which is that of "
          "the first K; allowed are its entries, or a pattern= that has all",
          what_, row, column_, value));
    }
  }

 private:
  SymmetricMatrix& k_;
  const char* what_;
  Index column_ = 0, at_ = 0;
};

void require_shape(const char* what, const std::string& is, Index n) {
  throw std::invalid_argument(fmt::format("{}: {}; allowed is {} x {}", what, is, n, n));
}

void fill_dense(const py::object& result, const char* what, SymmetricMatrix& k) {
  const Doubles dense = Doubles::ensure(result);
  const Index n = k.cols();
  if (!dense || dense.ndim() != 2 || dense.shape(0) != n || dense.shape(1) != n)
    require_shape(what, "it returned something else", n);
  Filling filling(k, what);
  for (Index j = 0; j < n; ++j) {
    filling.begin(j);
    for (Index i = j; i < n; ++i) filling.put(i, dense.at(i, j));
  }
}

void fill_columns(const py::tuple& columns, const char* what, SymmetricMatrix& k) {
  const auto data = columns[0].cast<Doubles>();
  const auto rows = columns[1].cast<Indices>(), first = columns[2].cast<Indices>();
  if (first.size() != k.cols() + 1)
    require_shape(what, fmt::format("it has {} columns", first.size() - 1), k.cols());
  const std::int64_t entries = std::min(data.size(), rows.size());
  bool ascends = first.at(0) >= 0;
  for (Index j = 0; j < k.cols(); ++j) ascends = ascends && first.at(j) <= first.at(j + 1);
  if (!ascends || first.at(k.cols()) > entries)
    throw std::invalid_argument(fmt::format(
        "{}: its sparse matrix is broken: indptr does not ascend within its entries", what));
  Filling filling(k, what);
  for (Index j = 0; j < k.cols(); ++j) {
    filling.begin(j);
    for (std::int64_t a = first.at(j); a < first.at(j + 1); ++a) {
      if (rows.at(a) >= j) filling.put(rows.at(a), data.at(a));
    }
  }
}

}  // namespace

py::object Views::show(const double* place, bool may_write) {
  for (py::object& spare : spare_) {
    const py::array array = py::reinterpret_borrow<py::array>(spare);
    if (array.data() != place || array.writeable() != may_write) continue;
    py::object view = std::move(spare);
    spare = std::move(spare_.back());
    spare_.pop_back();
    return view;
  }
  py::array view(py::dtype::of<double>(), shape_, place, py::none());  // the solver's memory
  if (!may_write) view.attr("setflags")(py::arg("write") = false);
  return view;
}

void Views::take_back(py::object view, const char* callable, const char* argument) {
  if (Py_REFCNT(view.ptr()) > 1) {
    part(view);
    throw std::runtime_error(
        fmt::format("{}: it kept {} beyond its call, whose memory is the solver's; keep {}.copy()",
                    callable, argument, argument));
  }
  if (spare_.size() < most_spare) spare_.push_back(std::move(view));
}

void Views::part(const py::object& view) {
  if (Py_REFCNT(view.ptr()) == 1) return;
  auto* array = py::detail::array_proxy(view.ptr());
  const py::object own = py::reinterpret_borrow<py::array>(view).attr("copy")();
  array->data = py::detail::array_proxy(own.ptr())->data;
  Py_XSETREF(array->base, own.inc_ref().ptr());
}

OwnForces::OwnForces(Vec mass, std::vector<py::ssize_t> shape, Force force, Potential potential,
                     py::object stiffness, SymmetricMatrix pattern, bool is_linear,
                     py::object damping, SymmetricMatrix damping_pattern)
    : System(std::move(mass)),
      force_(std::move(force)),
      potential_(std::move(potential)),
      stiffness_(std::move(stiffness)),
      damping_(std::move(damping)),
      pattern_(std::move(pattern)),
      c_(std::move(damping_pattern)),
      is_linear_(is_linear),
      views_(std::move(shape)) {}

OwnForces::~OwnForces() {
  // The end of a run may free the last references.
  const py::gil_scoped_acquire acquired;
  force_ = CForce{};
  potential_ = {};
  stiffness_ = damping_ = {};
  views_ = Views({});
}

template <class Use>
void OwnForces::call(const py::object& callable, const char* name, const ConstVec& q,
                     const Use& use) const {
  py::object view = views_.show(q.data(), false);
  try {
    use(callable, view);
  } catch (...) {
    Views::part(view);
    throw;
  }
  views_.take_back(std::move(view), name, "q");
}

void OwnForces::force(const At& at, MutableVec f) const {
  elastic_force(at, f);
  if (damping_.is_none() || at.v.size() == 0) return;
  Vec of_damping(f.size());
  friction(at, of_damping);
  f += of_damping;
}

void OwnForces::friction(const At& at, MutableVec f) const {
  inside([&] {
    damping_matrix(at, c_);
    f = -(c_.selfadjointView<Eigen::Lower>() * at.v);
  });
}

void OwnForces::damping_matrix(const At& at, SymmetricMatrix& c) const {
  fill(damping_, "damping", at.q, c);
}

void OwnForces::elastic_force(const At& at, MutableVec f) const {
  const VecView& q = at.q;
  if (const auto* c = std::get_if<CForce>(&force_)) return (*c)(q.data(), f.data(), q.size());
  inside([&] {
    call(std::get<py::object>(force_), "force", q, [&](const py::object& callable, py::object& x) {
      py::object view = views_.show(f.data(), true);
      try {
        // A force may return the array that it was given, as NumPy's functions do.
        if (const py::object result = callable(x, view); !result.is_none() && !result.is(view))
          throw std::invalid_argument(
              "force: it returned something else than f; it writes into f, as np.copyto(f, -q) "
              "does");
      } catch (...) {
        Views::part(view);
        throw;
      }
      views_.take_back(std::move(view), "force", "f");
    });
  });
}

double OwnForces::potential(const At& at) const {
  const VecView& q = at.q;
  if (!has_potential()) throw std::logic_error("the System has no potential");
  if (const auto* c = std::get_if<CPotential>(&potential_)) return (*c)(q.data(), q.size());
  double v = 0;
  inside([&] {
    call(std::get<py::object>(potential_), "potential", q,
         [&](const py::object& callable, py::object& x) {
           v = PyFloat_AsDouble(callable(x).ptr());
           if (PyErr_Occurred()) throw py::error_already_set();
         });
  });
  return v;
}

void OwnForces::stiffness(const At& at, SymmetricMatrix& k) const {
  fill(stiffness_, "stiffness", at.q, k);
}

void OwnForces::fill(const py::object& of, const char* what, const ConstVec& q,
                     SymmetricMatrix& matrix) const {
  inside([&] {
    call(of, what, q, [&](const py::object& callable, py::object& x) {
      const py::object result = callable(x);
      if (py::isinstance<py::tuple>(result)) {
        fill_columns(result, what, matrix);
      } else {
        fill_dense(result, what, matrix);
      }
    });
  });
}

SymmetricMatrix pattern_of(const Indices& rows, const Indices& columns, Index n) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < n; ++i) entries.emplace_back(i, i, 0);
  for (py::ssize_t a = 0; a < rows.size(); ++a) {
    const Index i = rows.at(a), j = columns.at(a);
    if (i < 0 || j < 0 || i >= n || j >= n) {
      throw std::invalid_argument(
          fmt::format("pattern: entry ({}, {}) is not among the {} unknowns", i, j, n));
    }
    entries.emplace_back(std::max(i, j), std::min(i, j), 0);
  }
  SymmetricMatrix pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  return pattern;
}

}  // namespace qddot::python
