#include "experiments/kit/study.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/interruptible.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {
namespace {

// Long enough for a step of the largest scenes [s].
constexpr double patience_with_a_step = 30;

// A share counts all that its process does, from loading the scene on.
const auto process_began = std::chrono::steady_clock::now();

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

// The names of the roots by which shares were measured.
std::set<std::string> roots_of(const std::map<std::string, nlohmann::json>& pieces) {
  std::set<std::string> names;
  for (const auto& [name, piece] : pieces) {
    if (name.starts_with(whole_mark(""))) names.insert(piece.value("roots", "unknown"));
  }
  return names;
}

}  // namespace

std::string whole_mark(const std::string& share) { return "whole " + share; }

nlohmann::json whole_record(const nlohmann::json& failure) {
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - process_began;
  return {{"host", host()},
          {"date", date_now()},
          {"seconds", took.count()},
          {"roots", roots()},
          {"failure", failure}};
}

Study::Study(const StudyCall& call, const std::string& folder,
             const std::vector<std::string>& tables, const nlohmann::json& about,
             const Shares& shares)
    : program_(call.program),
      path_(folder + "/" + program_ + ".journal"),
      options_(call.options),
      key_({{"program", program_},
            {"about", about},
            {"options", options_},
            {"build", build()},
            {"machine", machine()}}),
      share_(call.share),
      is_kept_(call.is_of_kept) {
  progress().wipe();  // what was done before may have a line
  if (is_divided() || call.lists_shares) {
    for (const std::string& option : shares.chosen_by) key_["options"].erase(option);
  }
  if (call.lists_shares) {
    list(shares);
    return;
  }
  require_folder(folder);
  if (is_share()) {
    open_share(call, shares);
  } else if (is_kept_) {
    open_kept();
  } else {
    open(tables, folder, call.resumes);
  }
}

void Study::list(const Shares& shares) {
  fmt::print("{}\n", nlohmann::json{{"key", key_}, {"shares", shares.names}}.dump(
                         -1, ' ', true, nlohmann::json::error_handler_t::replace));
  completed_ = done;
}

void Study::open_share(const StudyCall& call, const Shares& shares) {
  if (std::ranges::find(shares.names, share_) == shares.names.end()) {
    throw InvalidInput(fmt::format("--share: {} is no share of this study; allowed are {}", share_,
                                   fmt::join(shares.names, ", ")));
  }
  path_ = call.journal;
  require_given(path_, "--journal", "the file for the results of the share");
  key_["share"] = share_;
  const Journal::Contents there = Journal::read(path_);
  const std::string what = there.whole > 0 ? difference(there.key, key_) : "";
  if (!what.empty()) {
    throw InvalidInput(
        fmt::format("--journal: {} is of another study: {}; allowed are the same scene, code and "
                    "options, or another file",
                    path_, what));
  }
  journal_ = std::make_unique<Journal>(path_, key_, /*goes_on=*/true);
  wait_for_answer(patience_with_a_step);
  if (journal_->find(whole_mark(share_))) completed_ = done;
}

void Study::open_kept() {
  Journal::Contents contents = Journal::read(path_);
  if (contents.whole == 0) {
    throw InvalidInput(
        fmt::format("--kept: {} is missing or no journal; allowed is a folder that "
                    "holds what was measured",
                    path_));
  }
  // The machine is the one on which it was measured.
  key_["machine"] = contents.key.value("machine", nlohmann::json());
  if (const std::string what = difference(contents.key, key_); !what.empty()) {
    throw InvalidInput(
        fmt::format("--kept: {} is of another study: {}; allowed are the same "
                    "scene, code and options",
                    path_, what));
  }
  kept_ = std::move(contents.pieces);
}

void Study::open(const std::vector<std::string>& tables, const std::string& folder, bool resumes) {
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

bool Study::takes(const std::string& share) const {
  if (is_share()) return share == share_;
  return !is_kept_ || kept_.contains(whole_mark(share));
}

std::vector<const Method*> Study::taken(std::vector<const Method*> methods) const {
  std::erase_if(methods, [&](const Method* method) { return !takes(method->name); });
  return methods;
}

nlohmann::json Study::piece(const std::string& name, const std::function<nlohmann::json()>& make) {
  if (is_kept_) {
    const auto known = kept_.find(name);
    if (known != kept_.end()) return known->second;
    throw InvalidInput(fmt::format("--kept: {} does not hold {}", path_, name));
  }
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
  } catch (const NoReference& error) {
    if (!is_share()) throw;
    failure_ = error.what();
  }
  progress().wipe();
  if (is_share() && !why_) journal_->keep(whole_mark(share_), whole_record(failure_));
}

void Study::complete(CsvFile& table, nlohmann::json origin, int status) {
  origin["study"] = key_;
  origin["study"]["options"] = options_;
  origin["exit_status"] = why_ ? why_->status : status;
  origin["interrupted"] = why_ ? nlohmann::json(why_->by) : nullptr;
  if (is_kept_) {
    origin.update(key_.at("machine"));
    origin["roots"] = fmt::format("{}", fmt::join(roots_of(kept_), ", "));
    std::erase(origin.at("command_line").get_ref<nlohmann::json::array_t&>(), "--kept");
  }
  table.complete(origin);
  complete_.push_back(&table);
}

void Study::complete(WholeFile& file) {
  file.complete();
  files_.push_back(&file);
}

bool Study::are_times_of_work() const {
  return is_kept_ && key_.at("machine").value("times", "") == "work";
}

int Study::conclude(int status) {
  for (CsvFile* table : complete_) table->commit();
  for (WholeFile* file : files_) file->commit();
  if (!why_) return conclude_whole(status);
  fmt::print(stderr, "{}: interrupted by {}; {} pieces are kept, and {} measures what is missing\n",
             program_, why_->by, journal_ ? journal_->size() : kept_.size(),
             is_share() ? "the same command" : "--resume");
  return why_->status;
}

int Study::conclude_whole(int status) {
  if (is_kept_) {
    std::filesystem::remove(path_);
  } else if (!is_share()) {
    journal_->remove();
  } else if (!failure_.is_null()) {
    fmt::print(stderr, "{}: {}\n", program_, in_one_line(failure_.get<std::string>()));
    return end_not_reached;
  }
  return status;
}

void side_by_side(std::size_t count, const std::function<void(std::size_t)>& work, int threads) {
  std::exception_ptr trouble, interruption;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::size_t i = 0; i < count; ++i) {
    try {
      work(i);
    } catch (const Interrupted&) {
#pragma omp critical
      interruption = std::current_exception();
    } catch (...) {  // which cannot leave a thread
#pragma omp critical
      trouble = std::current_exception();
    }
  }
  if (trouble) std::rethrow_exception(trouble);
  if (interruption) std::rethrow_exception(interruption);
}

}  // namespace qddot::inline kit
