#include "experiments/command/study.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <memory>

#include <fmt/format.h>

#include "experiments/command/command_line.hpp"
#include "experiments/command/interruptible.hpp"
#include "experiments/command/progress.hpp"
#include "experiments/command/provenance.hpp"
#include "qddot/measure/motion/interruption.hpp"

namespace qddot::command {

using namespace measure;
namespace {

// Long enough for a step of the largest scenes [s].
constexpr double patience_with_a_step = 30;

// What the user asked for, but for where results go and how the program is to be run.
nlohmann::json options_of(const CommandLine& line) {
  constexpr std::array other = {"--out",        "--scene",    "--resume", "--force",
                                "--time-limit", "--progress", "--help",   "--version"};
  nlohmann::json options = nlohmann::json::object();
  for (const auto& [name, values] : line.given()) {
    if (std::ranges::find(other, name) == other.end()) options[name] = values;
  }
  return options;
}

// The status of a study of this key that is complete: each of its tables says so.
std::optional<int> status_of(const std::vector<std::string>& tables, const nlohmann::json& key) {
  std::optional<int> status;
  for (const std::string& table : tables) {
    std::ifstream file(sidecar_of(table));
    const auto json = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
    if (!json.is_object() || json.value("study", nlohmann::json()) != key ||
        !json.value("interrupted", nlohmann::json("")).is_null() ||
        !std::filesystem::exists(table)) {
      return {};
    }
    status = json.value("exit_status", 0);
  }
  return status;
}

}  // namespace

void add_resume_option(CommandLine& line) {
  line.add_flag("--resume", "measure only what an interrupted run of the same command has not");
}

Study::Study(const CommandLine& line, const std::string& folder,
             const std::vector<std::string>& tables, const nlohmann::json& about)
    : program_(line.program()),
      path_(folder + "/" + program_ + ".journal"),
      key_({{"program", program_},
            {"about", about},
            {"options", options_of(line)},
            {"code", code_hash()},
            {"processor", processor()}}) {
  progress().wipe();  // what was done before may have a line
  const bool resumes = line.has("--resume");
  if (resumes && !std::filesystem::exists(path_)) {
    std::vector<std::string> paths;
    for (const std::string& table : tables) paths.push_back(folder + "/" + table);
    completed_ = status_of(paths, key_);
    if (completed_) {
      fmt::print(stderr, "{}: nothing is missing in {}\n", program_, folder);
      return;
    }
  }
  journal_ = std::make_unique<Journal>(path_, key_, resumes);
  wait_for_answer(patience_with_a_step);
  if (journal_->size() > 0) {
    fmt::print(stderr, "{}: {} pieces are kept from before\n", program_, journal_->size());
  } else if (journal_->dropped() > 0) {
    fmt::print(stderr,
               "{}: {} pieces of an interrupted run are measured anew (--resume keeps them)\n",
               program_, journal_->dropped());
  }
}

Study::~Study() {
  if (journal_ && journal_->size() == 0) journal_->remove();
}

nlohmann::json Study::piece(const std::string& name, const std::function<nlohmann::json()>& make) {
  if (auto known = journal_->find(name)) return *known;
  stop_if_interrupted();
  nlohmann::json made = make();
  stop_if_interrupted();
  journal_->keep(name, made);
  return made;
}

void Study::measure(const std::function<void()>& body) {
  try {
    body();
  } catch (const Interrupted&) {
    why_ = interrupted();
  }
  progress().wipe();
}

void Study::complete(CsvFile& table, nlohmann::json origin, int status) {
  origin["study"] = key_;
  origin["exit_status"] = why_ ? why_->status : status;
  origin["interrupted"] = why_ ? nlohmann::json(why_->by) : nullptr;
  table.complete(origin);
  complete_.push_back(&table);
}

int Study::conclude(int status) {
  for (CsvFile* table : complete_) table->commit();
  if (!why_) {
    journal_->remove();
    return status;
  }
  fmt::print(stderr,
             "{}: interrupted by {}; {} pieces are kept, and --resume measures what is missing\n",
             program_, why_->by, journal_->size());
  return why_->status;
}

int Study::finish(const std::vector<CsvFile*>& tables, const nlohmann::json& origin, int status) {
  for (CsvFile* table : tables) complete(*table, origin, status);
  return conclude(status);
}

}  // namespace qddot::command
