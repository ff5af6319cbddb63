#include "experiments/sweep/task.hpp"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include "experiments/kit/journal.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::sweep {

// Looked for in the namespace of the type.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Task, id, stage, folder, program, share, arguments, key, varied,
                                   entry, order)

namespace {

std::string path_of(const std::string& folder) { return folder + "/tasks.jsonl"; }

std::string text_of(const nlohmann::json& json) {
  return json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

bool is_sound(const Task& task) {
  const auto is_name = [](const std::string& name) {
    return !name.empty() && name.find('/') == name.npos && !name.starts_with('.');
  };
  return (task.stage == references || task.stage == points) && is_name(task.folder) &&
         is_name(task.program) && task.id == id_of(task.key, task.share);
}

}  // namespace

std::string id_of(nlohmann::json key, const std::string& share) {
  key.erase("machine");
  key["share"] = share;
  return text_hash(text_of(key));
}

std::vector<Task> read_tasks(const std::string& folder) {
  const std::string path = path_of(folder);
  std::ifstream file(path);
  std::vector<Task> tasks;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const auto json = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
    bool is_good = false;
    try {
      tasks.push_back(json.get<Task>());
      is_good = is_sound(tasks.back());
    } catch (const nlohmann::json::exception&) {  // written by somebody else
    }
    if (!is_good) {
      throw InvalidInput(fmt::format(
          "{}:{}: it is no task as sweep plan writes it; allowed is to plan the study again", path,
          number));
    }
  }
  if (tasks.empty()) {
    throw InvalidInput(fmt::format(
        "{}: it is missing or empty; allowed is a folder that sweep plan has filled", path));
  }
  if (const auto what = difference(tasks.front().key.value("build", nlohmann::json()), build());
      !what.empty()) {
    throw InvalidInput(fmt::format(
        "{}: it was planned by another build of qddot: {}; allowed are that build, or to plan the "
        "study again",
        path, what));
  }
  return tasks;
}

void write_tasks(const std::string& folder, std::vector<Task> tasks) {
  std::ranges::sort(tasks, {},
                    [](const Task& task) { return std::pair(task.stage != references, task.id); });
  // qddot may replace the file: its first line has the hash of the sources.
  WholeFile file(path_of(folder), R"({"arguments":)");
  for (const Task& task : tasks) file.write(text_of(task) + "\n");
  file.complete();
  file.commit();
}

Command command_of(const Task& task, const std::string& folder, const std::string& journal) {
  Command command = task.arguments;
  command.insert(command.begin(), program_path(task.program));
  for (const auto& word :
       {std::string("--out"), folder + "/" + task.folder, std::string("--share"), task.share,
        std::string("--journal"), journal, std::string("--progress"), std::string("none")})
    command.push_back(word);
  return command;
}

}  // namespace qddot::sweep
