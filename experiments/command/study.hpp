#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/command/command_line.hpp"
#include "experiments/command/csv.hpp"
#include "experiments/command/journal.hpp"
#include "experiments/command/shares.hpp"
#include "qddot/measure/motion/interruption.hpp"

namespace qddot::command {

using namespace measure;

// Adds --resume.
void add_resume_option(CommandLine& line);

// A study that is measured piece by piece into tables of one folder, and that may be interrupted
// at any time: each piece is kept in `folder`/PROGRAM.journal as it comes. The same command with
// --resume finds the pieces there again and measures what is missing; the journal goes once all
// tables are complete.
//
// Several processes may divide it. With --list-shares it prints, as JSON, the "key" of the study
// and its "shares"; with --share NAME --journal FILE it measures that one into the file and makes
// no tables; with --kept it makes the tables of the shares that `folder`/PROGRAM.journal holds
// whole, wherever they were measured, and measures nothing.
class Study {
 public:
  // `about`: what decides the results beside the program's options and the code: the scene's hash,
  // say; `tables`: the files X.csv in `folder` that it makes. Makes the folder, unless it lists
  // shares. Says on stderr what is kept, or what is measured anew, of an interrupted run. Throws
  // InvalidInput as Journal does, and for a share that there is not.
  Study(const CommandLine& line, const std::string& folder, const std::vector<std::string>& tables,
        const nlohmann::json& about, const Shares& shares = {});
  // Leaves no journal where nothing was measured.
  ~Study();
  Study(const Study&) = delete;
  Study& operator=(const Study&) = delete;

  // What it ended with, where there is nothing to do: --resume finds it complete, or shares were
  // listed.
  std::optional<int> completed() const { return completed_; }
  // Whether one share alone is measured, so that there are no tables.
  bool is_share() const { return !share_.empty(); }
  // Whether processes divide it, so that no share may learn from another.
  bool is_divided() const { return is_share() || is_kept_; }
  // Whether the pieces of that share are to be had: measured now, or kept.
  bool takes(const std::string& share) const;
  // Whether it may be measured now.
  bool measures(const std::string& share) const { return !is_kept_ && takes(share); }

  // The piece of that name: as it was kept, or made now and kept. Throws Interrupted where the
  // program is to end; what was made meanwhile counts for nothing. Thread-safe.
  nlohmann::json piece(const std::string& name, const std::function<nlohmann::json()>& make);

  // Runs `body`, which makes pieces and ends early where the program is to end. Takes the line of
  // the progress away. A share is whole after it, also where NoReference was thrown.
  void measure(const std::function<void()>& body);

  // Completes a table, whose sidecar says that it is of this study, and in `interrupted` by what
  // that was ended, or null. `status`: what the program returns if it was not.
  void complete(CsvFile& table, nlohmann::json origin, int status);
  // Lets all tables appear. Returns `status`, or that of the interruption, of which it says what to
  // do next.
  int conclude(int status);
  // Both, for tables of one origin.
  int finish(const std::vector<CsvFile*>& tables, const nlohmann::json& origin, int status);

 private:
  void list(const Shares& shares);
  void open_share(const CommandLine& line, const Shares& shares);
  void open_kept();
  void open(const std::vector<std::string>& tables, const std::string& folder, bool resumes);
  int conclude_whole(int status);

  std::string program_, path_;
  nlohmann::json options_, key_;
  std::string share_;  // none where all are measured
  bool is_kept_ = false;
  std::map<std::string, nlohmann::json> kept_;
  std::optional<int> completed_;
  std::unique_ptr<Journal> journal_;
  std::optional<Interruption> why_;  // measure() ended early
  nlohmann::json failure_;           // of a share that has no reference, in words
  std::vector<CsvFile*> complete_;
};

}  // namespace qddot::command
