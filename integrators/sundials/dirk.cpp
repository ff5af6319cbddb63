// ARKODE's adaptive diagonally implicit Runge-Kutta methods of order 2 to 5. With y = (q, v),
// F(y) = (v, M^-1 f(q)) and the coefficients a_ij and b_i of the named table:
//   Y_i     = y_n + h sum_{j<=i} a_ij F(Y_j),   i = 1 ... s
//   y_{n+1} = y_n + h sum_{i<=s} b_i F(Y_i)
// Other weights of the same table estimate the error, and the next step size follows from it. Each
// implicit stage is solved by Newton's method with the matrix I - h a_ii dF/dy.
//
// The methods eliminate v and solve with the symmetric n x n matrix M - (h a_ii)^2 K. Their twins
// of the ending _klu give the 2n x 2n matrix to KLU, as SUNDIALS' users do. Both take the same
// steps.
#include <string>

#include <fmt/format.h>

#include "integrators/sundials/arkode.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

using namespace sundials;

struct Table {
  int order;
  ARKODE_DIRKTableID id;
  const char* name;
  const char* source;
};
constexpr Table tables[] = {
    {2, ARKODE_SDIRK_2_1_2, "SDIRK_2_1_2", "SUNDIALS 6.4.1 ARKODE guide, table SDIRK_2_1_2"},
    {3, ARKODE_KVAERNO_4_2_3, "KVAERNO_4_2_3",
     "Kvaerno, BIT Numerical Mathematics 44 (2004) 489-502"},
    {4, ARKODE_SDIRK_5_3_4, "SDIRK_5_3_4",
     "Hairer and Wanner, Solving ODEs II, table IV.6.5, SDIRK4(3)5"},
    {5, ARKODE_ESDIRK547L2SA_7_4_5, "ESDIRK547L2SA_7_4_5",
     "Kennedy and Carpenter, Applied Numerical Mathematics 146 (2019), ESDIRK5(4)7L[2]SA"}};

template <int order, MakeMatrix make_matrix>
class Dirk final : public Arkode {
  static constexpr Table table = tables[order - 2];

 public:
  explicit Dirk(SystemRun& run)
      : Arkode(run,
               {.implicit_table = ButcherTable(check(ARKodeButcherTable_LoadDIRK(table.id))).get()},
               nullptr, right_hand_side, make_matrix, run.system()) {}
};

template <int order, MakeMatrix make_matrix>
Method dirk(const std::string& name, const char* solver, const std::string& stock_of = {}) {
  static_assert(tables[order - 2].order == order);
  const Table& table = tables[order - 2];
  return {.name = name,
          .summary = fmt::format("SUNDIALS ARKODE, adaptive DIRK of order {}, ARKODE_{}, {}", order,
                                 table.name, solver),
          .source = table.source,
          .order = order,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .traits = {Trait::implicit},
          .needs = {Need::conservative, Need::stiffness},
          .takes = SetOf<Option>{}.with(Option::solver, make_matrix == make_structured),
          .stock_of = stock_of,
          .damped = Damped::by_any,
          .make = create_steps<Dirk<order, make_matrix>>};
}
template <int order>
Method structured() {
  return dirk<order, make_structured>(fmt::format("arkode_dirk{}", order), "n x n solves");
}
template <int order>
Method stock() {
  const auto own = structured<order>().name;
  return dirk<order, make_klu>(own + "_klu", "stock KLU", own);
}

}  // namespace

Method arkode_dirk2() { return structured<2>(); }
Method arkode_dirk3() { return structured<3>(); }
Method arkode_dirk4() { return structured<4>(); }
Method arkode_dirk5() { return structured<5>(); }
Method arkode_dirk2_klu() { return stock<2>(); }
Method arkode_dirk3_klu() { return stock<3>(); }
Method arkode_dirk4_klu() { return stock<4>(); }
Method arkode_dirk5_klu() { return stock<5>(); }

}  // namespace qddot::registered
