#pragma once

#include <span>
#include <string>
#include <variant>

#include "qddot/integrators/method.hpp"
#include "qddot/integrators/options.hpp"

namespace qddot {

struct EveryMethod {};
// The methods that take an option: all, those of a knob, or those with it in Method::takes.
using Takers = std::variant<EveryMethod, Knob, Option>;

// An option of a run as C++, the programs and Python have it. Options that only code sets, as
// Options::timed, have no row.
struct OptionRow {
  const char* name;  // of the member of Options and of Python's argument; see program_name
  const char* unit;  // SI; empty for numbers without one, flags and solvers
  std::variant<double Options::*, int Options::*, bool Options::*, Solver Options::*> member;
  Takers takers;
  const char* words;                     // one line of help
  bool (*allows)(double) = nullptr;      // whether Options may hold that finite number; null: any
  const char* allowed = "";              // the numbers that it may hold, after "it is"
  bool is_of_programs = true;            // whether a command line has it
  bool zero_is_own = false;              // whether 0 is the method's own choice, and never written
  const char* allowed_in_programs = "";  // the same on command lines, if other words fit there
  int most_in_programs = 0;              // the largest whole number there; 0: the method's order

  // Its spelling on command lines: "--step-size" for step_size.
  std::string program_name() const;
  // Whether Options may hold that number; none is infinite.
  bool accepts(double number) const;
  // The numbers that a command line may give, after "it is".
  const char* words_for_programs() const;
  // "number", "integer", "flag" or "solver".
  const char* kind() const;
};

// The table of all options, in the order of lists and checks.
std::span<const OptionRow> option_rows();

// The row of that name. Throws std::invalid_argument if there is none.
const OptionRow& option_row(const std::string& name);

// Whether the method takes the option.
bool takes(const Method& method, const OptionRow& row);

// Whether the option is one of those in Method::takes.
inline bool is_of_takes(const OptionRow& row) { return std::holds_alternative<Option>(row.takers); }

}  // namespace qddot
