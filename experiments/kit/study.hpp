#pragma once

#include <functional>
#include <map>
#include <memory>
#include <omp.h>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/kit/csv.hpp"
#include "experiments/kit/journal.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/integrators/method.hpp"
#include "qddot/measure/motion/interruption.hpp"

namespace qddot::inline kit {

// The parts of a study that several processes can measure independently.
struct Shares {
  std::vector<std::string> names{};
  // The options that choose the shares. A share does not depend on the others that are chosen.
  std::vector<std::string> chosen_by{};
};

// The share that makes the reference of all others.
inline const std::string reference_share = "reference";

// The name of the piece that marks a share as complete.
std::string whole_mark(const std::string& share);
// That piece: the machine, the date and the seconds of the process until now. "failure" says in
// words why there is no reference to measure against; null if there is one.
nlohmann::json whole_record(const nlohmann::json& failure);

// The command line of a study.
struct StudyCall {
  std::string program;
  // The options that decide results, with their values.
  nlohmann::json options = nlohmann::json::object();
  bool resumes = false, lists_shares = false, is_of_kept = false;
  std::string share{}, journal{};  // empty if all shares are measured
};

// A study that is measured piece by piece into tables in one folder and may be interrupted at any
// time. Each piece is kept in `folder`/PROGRAM.journal when it is measured. The same command with
// --resume reads these pieces and measures the missing ones. The journal is removed when all tables
// are complete.
//
// Several processes may divide a study:
// - --list-shares prints, as JSON, the "key" of the study and its "shares",
// - --share NAME --journal FILE measures that share into the file and makes no tables,
// - --kept measures nothing and makes the tables of all complete shares in
//   `folder`/PROGRAM.journal, wherever they were measured.
class Study {
 public:
  // `about`: all that decides the results beside the program's options and the code, as the scene's
  // hash. `tables`: the files X.csv in `folder` that it makes. Makes the folder, unless it lists
  // shares. Says on stderr how many pieces of an interrupted run it keeps or measures anew. Throws
  // InvalidInput as Journal does, and for an unknown share.
  Study(const StudyCall& call, const std::string& folder, const std::vector<std::string>& tables,
        const nlohmann::json& about, const Shares& shares = {});
  // Removes the journal if nothing was measured.
  ~Study();
  Study(const Study&) = delete;
  Study& operator=(const Study&) = delete;

  // The exit status if there is nothing to do: --resume finds the study complete, or shares were
  // listed.
  std::optional<int> completed() const { return completed_; }
  // Whether only one share is measured, without tables.
  bool is_share() const { return !share_.empty(); }
  // Whether several processes divide the study, so that no share may use results of another.
  bool is_divided() const { return is_share() || is_kept_; }
  // Whether the pieces of that share are available: measured now, or kept.
  bool takes(const std::string& share) const;
  // Those methods whose shares are.
  std::vector<const Method*> taken(std::vector<const Method*> methods) const;
  // Whether the share may be measured now.
  bool measures(const std::string& share) const { return !is_kept_ && takes(share); }

  // The piece of that name: the kept one, or made now and kept. Throws Interrupted if the program
  // is to end; a piece in progress is discarded then. Thread-safe.
  nlohmann::json piece(const std::string& name, const std::function<nlohmann::json()>& make);

  // Something could not be measured: the exit status will be end_not_reached.
  void fall_short() { falls_short_ = true; }
  bool falls_short() const { return falls_short_; }

  // Runs `body`, which makes pieces, until its end or an interruption, and removes the line of the
  // progress. Marks a share as complete, even if NoReference was thrown.
  void measure(const std::function<void()>& body);

  // Completes a table. Its sidecar names this study, and "interrupted" says what ended it, or null.
  // `status`: exit status of the program if nothing ended it.
  void complete(CsvFile& table, nlohmann::json origin, int status);
  // Completes a file that appears together with the tables.
  void complete(WholeFile& file);
  // By what measure() was ended early; empty if it was not.
  std::string interrupted_by() const { return why_ ? why_->by : ""; }
  // Whether the times in the pieces are counts times costs (see `sweep merge --by work`).
  bool are_times_of_work() const;
  // Gives all tables and files their names. Returns `status`, or that of the interruption after a
  // message on how to go on.
  int conclude(int status);

 private:
  void list(const Shares& shares);
  void open_share(const StudyCall& call, const Shares& shares);
  void open_kept();
  void open(const std::vector<std::string>& tables, const std::string& folder, bool resumes);
  int conclude_whole(int status);

  std::string program_, path_;
  nlohmann::json options_, key_;
  std::string share_;  // empty if all are measured
  bool is_kept_ = false, falls_short_ = false;
  std::map<std::string, nlohmann::json> kept_;
  std::optional<int> completed_;
  std::unique_ptr<Journal> journal_;
  std::optional<Interruption> why_;  // if measure() ended early
  nlohmann::json failure_;           // of a share without a reference, in words
  std::vector<CsvFile*> complete_;
  std::vector<WholeFile*> files_;
};

// Calls work(i) for each i below `count` on so many threads (OpenMP). Throws, when all threads have
// ended, what one of the calls threw; Interrupted only if nothing else was.
void side_by_side(std::size_t count, const std::function<void(std::size_t)>& work,
                  int threads = omp_get_max_threads());

}  // namespace qddot::inline kit
