#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "experiments/kit/command_line.hpp"

namespace qddot::inline kit {

// The parts of a study that several processes can measure independently.
struct Shares {
  std::vector<std::string> names{};
  // The options that choose the shares. A share does not depend on the others that are chosen.
  std::vector<std::string> chosen_by{};
};

// The share that makes the reference of all others.
inline const std::string reference_share = "reference";

// Adds --list-shares, --share, --journal and --kept (see study.hpp).
void add_share_options(CommandLine& line);
// Whether --list-shares and --kept were given; false for programs without them.
bool lists_shares(const CommandLine& line);
bool is_of_kept(const CommandLine& line);
// The values of --share and --journal; empty if not given.
std::string share_of(const CommandLine& line);
std::string journal_of(const CommandLine& line);

// The name of the piece that marks a share as complete.
std::string whole_mark(const std::string& share);
// That piece: the machine, the date and the seconds of the process until now. "failure" says in
// words why there is no reference to measure against; null if there is one.
nlohmann::json whole_record(const nlohmann::json& failure);

}  // namespace qddot::inline kit
