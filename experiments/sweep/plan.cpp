#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/program.hpp"
#include "experiments/sweep/actions.hpp"
#include "experiments/sweep/study_file.hpp"
#include "experiments/sweep/task.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::sweep {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t most_tasks = 1000000;

// The value of --scene.
std::string scene_word(const StudyScene& scene, const std::string& study_path,
                       const std::string& folder) {
  if (!scene.text.empty()) {
    require_folder(folder + "/scenes");
    // Its name holds its content, so that no earlier plan's is replaced.
    std::string path = fmt::format("{}/scenes/{}-{}.toml", folder, scene.label,
                                   text_hash(scene.text).substr(0, 8));
    write_whole(path, signed_text(scene.text));
    return path;
  }
  if (scene.source.empty() || find_generator(scene.source)) return scene.source;
  const auto path = fs::path(study_path).parent_path() / scene.source;
  return fs::absolute(path).lexically_normal().string();
}

// The program's arguments for the scene and these methods, or for all methods if there are none.
std::vector<std::string> arguments_of(const StudyFile& study, const StudyScene& scene,
                                      const std::string& scene_word,
                                      const std::vector<std::string>& methods) {
  std::vector<std::string> words;
  const auto add = [&](const char* option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  if (!scene_word.empty()) add("--scene", scene_word);
  if (scene.until > 0) add("--until", fmt::format("{}", scene.until));
  if (!study.accuracies.empty())
    add("--accuracies", fmt::format("{}", fmt::join(study.accuracies, ",")));
  if (!methods.empty()) add("--methods", fmt::format("{}", fmt::join(methods, ",")));
  for (const auto& [name, value] : study.options) {
    words.push_back("--" + name);
    if (!value.empty()) words.push_back(value);
  }
  return words;
}

// The program's list of what it can measure apart (its study's key and its shares), or the reason
// why it refuses.
struct Listed {
  std::vector<std::string> arguments;
  nlohmann::json found{};
  std::string refusal{};
};

Listed listed(const StudyFile& study, const std::vector<std::string>& arguments) {
  const ChildEnd end = run_child(command_of(study.program, arguments, ".", {"--list-shares"}));
  stop_if_interrupted();
  const auto found = nlohmann::json::parse(end.out, nullptr, /*allow_exceptions=*/false);
  const bool is_good = end.status == done && found.is_object();
  return {arguments, found, is_good ? "" : end.cause()};
}

// The shares of a scene, without those of methods that cannot run it.
Listed shares_of(const StudyFile& study, const StudyScene& scene, const std::string& scene_word) {
  Listed all = listed(study, arguments_of(study, scene, scene_word, study.methods));
  if (all.refusal.empty() || study.methods.empty()) return all;
  const Listed any = listed(study, arguments_of(study, scene, scene_word, {}));
  if (!any.refusal.empty()) return all;
  const auto shares = any.found.at("shares").get<std::vector<std::string>>();
  std::vector<std::string> fitting = study.methods;
  std::erase_if(fitting, [&](const std::string& method) {
    return std::ranges::find(shares, method) == shares.end();
  });
  if (fitting.empty() || fitting.size() == study.methods.size()) return all;
  return listed(study, arguments_of(study, scene, scene_word, fitting));
}

// The tasks of the study of a file, scene by scene: what its program says of each scene that it can
// measure apart. Writes scene files that the study asks for into `folder`/scenes.
std::vector<Task> tasks_of(const StudyFile& study, const std::string& study_path,
                           const std::string& folder) {
  std::vector<Task> tasks;
  progress().begin(study.scenes.size());
  for (const StudyScene& scene : study.scenes) {
    progress().now_at(scene.label);
    const Listed all = shares_of(study, scene, scene_word(scene, study_path, folder));
    if (!all.refusal.empty())
      throw InvalidInput(fmt::format("{}: {}: {}", study_path, scene.label, all.refusal));
    nlohmann::json key = all.found.at("key");
    key.erase("machine");
    for (const auto& share : all.found.at("shares")) {
      tasks.push_back({.id = id_of(key, share),
                       .stage = share == reference_share ? references : points,
                       .folder = scene.label,
                       .program = study.program,
                       .share = share,
                       .arguments = all.arguments,
                       .key = key,
                       .varied = scene.varied,
                       .entry = scene.entry,
                       .order = tasks.size()});
    }
    if (tasks.size() > most_tasks) {
      throw InvalidInput(
          fmt::format("{}: its tasks are more than {}; allowed are fewer scenes or "
                      "methods",
                      study_path, most_tasks));
    }
    progress().finish(scene.label);
  }
  progress().wipe();
  return tasks;
}

}  // namespace

int plan(const std::string& study_path, const std::string& out) {
  protect_input(study_path);
  const StudyFile study = read_study(study_path);
  const std::string folder = fs::absolute(out).lexically_normal().string();
  const std::string scenes = folder + "/scenes";
  const bool is_new = !fs::exists(folder), had_scenes = fs::exists(scenes);
  std::vector<Task> tasks;
  try {
    tasks = tasks_of(study, study_path, folder);
    require_folder(folder);
  } catch (...) {  // nothing half planned is left behind
    if (!had_scenes) fs::remove_all(scenes);
    if (is_new) fs::remove_all(folder);
    throw;
  }
  write_tasks(folder, tasks);
  const TaskFiles files(folder, /*makes_folders=*/true);
  const auto kept = std::ranges::count_if(
      tasks, [&](const Task& task) { return files.contents(task).has_value(); });
  const auto first = std::ranges::count(tasks, references, &Task::stage);
  fmt::print("{}: {} scenes, {} references, {} tasks of points", folder, study.scenes.size(), first,
             std::ssize(tasks) - first);
  if (kept > 0) fmt::print("; {} of these are measured already", kept);
  fmt::print("\n");
  return done;
}

}  // namespace qddot::sweep
