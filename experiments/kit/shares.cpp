#include "experiments/kit/shares.hpp"

#include <chrono>
#include <optional>

#include <nlohmann/json.hpp>

#include "experiments/kit/provenance.hpp"

namespace qddot::inline kit {
namespace {

// A share counts all that its process does, from loading the scene on.
const auto process_began = std::chrono::steady_clock::now();

// The last value of an option; nothing where it was not given.
std::optional<std::string> given(const CommandLine& line, const std::string& option) {
  for (const auto& [name, values] : line.given()) {
    if (name == option) return values.empty() ? "" : values.back();
  }
  return {};
}

}  // namespace

void add_share_options(CommandLine& line) {
  static std::string share, journal;  // given() has what they were given
  line.add_flag("--list-shares",
                "print, as JSON, the shares of the study that processes can measure independently, "
                "and its key");
  line.add_option("--share", share, "measure this share alone, into the file --journal")
      .take_last();
  line.add_option("--journal", journal, "the file for the results of --share").take_last();
  line.add_flag(
      "--kept",
      "measure nothing: make the tables from the complete shares in the folder's journal");
}

bool lists_shares(const CommandLine& line) { return given(line, "--list-shares").has_value(); }

bool is_of_kept(const CommandLine& line) { return given(line, "--kept").has_value(); }

std::string share_of(const CommandLine& line) { return given(line, "--share").value_or(""); }

std::string journal_of(const CommandLine& line) { return given(line, "--journal").value_or(""); }

std::string whole_mark(const std::string& share) { return "whole " + share; }

nlohmann::json whole_record(const nlohmann::json& failure) {
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - process_began;
  return {{"host", host()},
          {"date", date_now()},
          {"seconds", took.count()},
          {"roots", roots()},
          {"failure", failure}};
}

}  // namespace qddot::inline kit
