#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/command/command_line.hpp"
#include "experiments/command/csv.hpp"
#include "experiments/command/journal.hpp"
#include "qddot/measure/motion/interruption.hpp"

namespace qddot::command {

using namespace measure;

// Adds --resume.
void add_resume_option(CommandLine& line);

// A study that is measured piece by piece into tables of one folder, and that may be interrupted
// at any time: each piece is kept in `folder`/PROGRAM.journal as it comes. The same command with
// --resume finds the pieces there again and measures what is missing; the journal goes once all
// tables are complete.
class Study {
 public:
  // `about`: what decides the results beside the program's options and the code: the scene's hash,
  // say; `tables`: the files X.csv in `folder` that it makes. Says on stderr what is kept, or what
  // is measured anew, of an interrupted run. Throws InvalidInput as Journal does.
  Study(const CommandLine& line, const std::string& folder, const std::vector<std::string>& tables,
        const nlohmann::json& about);
  // Leaves no journal where nothing was measured.
  ~Study();
  Study(const Study&) = delete;
  Study& operator=(const Study&) = delete;

  // What it ended with, where --resume finds it complete: there is nothing to do then.
  std::optional<int> completed() const { return completed_; }

  // The piece of that name: as it was kept, or made now and kept. Throws Interrupted where the
  // program is to end; what was made meanwhile counts for nothing. Thread-safe.
  nlohmann::json piece(const std::string& name, const std::function<nlohmann::json()>& make);

  // Runs `body`, which makes pieces and ends early where the program is to end. Takes the line of
  // the progress away.
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
  std::string program_, path_;
  nlohmann::json key_;
  std::optional<int> completed_;
  std::unique_ptr<Journal> journal_;
  std::optional<Interruption> why_;  // measure() ended early
  std::vector<CsvFile*> complete_;
};

}  // namespace qddot::command
