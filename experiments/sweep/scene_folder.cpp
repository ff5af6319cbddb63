#include "experiments/sweep/scene_folder.hpp"

#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/kit/whole_file.hpp"
#include "experiments/sweep/work_costs.hpp"

namespace qddot::sweep {
namespace {

namespace fs = std::filesystem;

// References that were made in the scene's own folder, beside other tables of it.
void copy_references(const std::string& from, const std::string& to) {
  std::error_code error;
  if (fs::equivalent(from, to, error)) return;
  for (const auto& entry : fs::recursive_directory_iterator(from)) {
    if (entry.path().filename() != "reference.json") continue;
    const fs::path copy = to / fs::relative(entry.path(), from);
    fs::create_directories(copy.parent_path());
    fs::copy_file(entry.path(), copy, fs::copy_options::overwrite_existing);
  }
}

std::string cause_of(const ChildEnd& end) {
  const bool is_done = end.status == done || end.status == end_not_reached;
  return is_done && end.signal == 0 ? "" : end.cause();
}

}  // namespace

std::string make_tables(const TaskFiles& files, const SceneTasks& part, bool by_work) {
  const Task& first = part.tasks.front();
  require_folder(part.out);
  copy_references(files.folder() + "/" + first.folder, part.out);
  nlohmann::json key = first.key;
  key["machine"] = by_work ? machine() : part.machine;
  if (by_work) key["machine"]["times"] = "work";  // for who draws them
  {
    const WorkCosts costs =
        by_work ? costs_for(first, files.folder() + "/" + first.folder) : WorkCosts();
    Journal journal(fmt::format("{}/{}.journal", part.out, first.program), key, /*goes_on=*/false);
    for (const Task& task : part.tasks) {
      const auto contents = files.contents(task);
      if (!contents) continue;  // somebody took it away meanwhile
      for (const auto& [name, piece] : contents->pieces)
        journal.keep(name, by_work ? sweep::by_work(piece, costs) : piece);
    }
  }
  Command command = first.arguments;
  command.insert(command.begin(), program_path(first.program));
  for (const auto& word : {"--out", part.out.c_str(), "--kept", "--progress", "none"})
    command.emplace_back(word);
  return cause_of(run_child(command));
}

std::string run_script(const std::string& script, const std::string& folder) {
  // Debian's own Python, which has matplotlib.
  return cause_of(run_child(
      {"/usr/bin/python3", "-B", fmt::format("{}/{}", QDDOT_EXPERIMENTS, script), folder}));
}

void set_environment_of_scripts() {
  const std::string experiments = QDDOT_EXPERIMENTS;
  ::setenv("PYTHONPATH", (experiments + "/plot:" + experiments + "/report").c_str(), 1);
  ::setenv("LC_ALL", "C", 1);
}

std::string draw(const SceneTasks& part) {
  const std::string program = part.tasks.front().program;
  std::string cause = run_script(fmt::format("{0}/{0}.py", program), part.out);
  if (cause.empty() && program == "work_precision")
    cause = run_script("report/report.py", part.out);
  return cause;
}

}  // namespace qddot::sweep
