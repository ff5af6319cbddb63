// Do spoiled scene and mesh files always end in a valid scene or in one sentence?
//
//   fuzz_scenes --count 1000000 --seed 1
//
// Each input is a file of the folder corpus with random changes. A scene that is
// taken must be valid and within the limits; a part of them is written and read back, to the bit.
// A refusal must be an InvalidInput of one line. Anything else ends the program with
// status 1 after the input.
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/fuzz/mutator.hpp"
#include "tests/scene/same_scene.hpp"

// There where the program is built with a sanitizer.
extern "C" void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));

namespace qddot {
namespace {

// Good files by name: scenes of all kinds, and meshes of all formats, which the scenes name.
std::map<std::string, std::string> read_corpus() {
  std::map<std::string, std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator(CORPUS)) {
    std::ifstream file(entry.path(), std::ios::binary);
    texts[entry.path().filename().string()].assign(std::istreambuf_iterator(file), {});
  }
  return texts;
}
const auto corpus = read_corpus();

// The present input, to be shown if the program dies of it.
std::string input;
std::uint64_t input_seed;

void show_input() {
  const std::string head =
      fmt::format("\nfuzz_scenes: this input, --count 1 --seed {}:\n", input_seed);
  for (const std::string_view part : {std::string_view(head), std::string_view(input)}) {
    if (::write(STDERR_FILENO, part.data(), part.size()) < 0) return;
  }
}

void show_input_at_death() {
  if (__sanitizer_set_death_callback) {
    __sanitizer_set_death_callback(show_input);
    return;
  }
  // An exhausted stack has no room for the handler.
  static std::array<char, 1 << 16> stack;
  const stack_t other{.ss_sp = stack.data(), .ss_flags = 0, .ss_size = stack.size()};
  ::sigaltstack(&other, nullptr);
  struct sigaction action {};
  action.sa_flags = SA_ONSTACK;
  action.sa_handler = [](int) {
    show_input();
    ::_exit(1);
  };
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT})
    ::sigaction(signal, &action, nullptr);
}

[[noreturn]] void fail(const std::string& why) {
  show_input();
  fmt::print(stderr, "\nfuzz_scenes: {}\n", why);
  std::exit(1);
}

constexpr SceneLimits limits{.nodes = 100, .springs = 300};

// A scene file, or one that takes all that a mesh has. Both name their meshes.
Scene read(const std::string& name, bool bends) {
  const bool is_scene = name.ends_with(".toml");
  const auto source = [&](const std::string& file) {
    if (!is_scene) return input;
    const auto found = corpus.find(file);
    if (found == corpus.end())
      throw InvalidInput(fmt::format("{}: there is no such file; allowed are others", file));
    return found->second;
  };
  const std::string around_mesh = fmt::format(
      "[mesh]\nfile = '{}'\nstiffness = 3\nnode_mass = 2\nbending_stiffness = {}\n"
      "pin = [{{min = [0, 0, 0], max = [1, 0.5, 0]}}]\n",
      name, bends ? 1.5 : 0);
  return parse_scene(is_scene ? input : around_mesh, "fuzz.toml", "", limits, source);
}

void check_scene(const Scene& scene, bool writes) {
  try {
    validate(scene, "fuzz.toml");
    require_within(limits, {scene.nodes.size(), scene.springs.size()}, "fuzz.toml");
    if (!writes) return;
    const Scene again = parse_scene(to_toml(scene), "written.toml", "", limits);
    const std::string difference = first_difference(scene, again);
    if (!difference.empty()) fail(fmt::format("written and read back, {} differs", difference));
  } catch (const InvalidInput& refusal) {
    fail(fmt::format("a scene was taken, and then refused: {}", refusal.what()));
  }
}

void check_refusal(const std::string& sentence) {
  const bool is_one_line =
      std::ranges::none_of(sentence, [](char c) { return static_cast<unsigned char>(c) < ' '; });
  const bool is_whole = sentence.starts_with("fuzz.toml:") && sentence.size() < 2000;
  if (!is_one_line || !is_whole)
    fail(fmt::format("this refusal is not one sentence: {}", sentence));
}

// Whether the input of that seed gave a scene.
bool try_one(std::uint64_t seed) {
  Mutator mutator(seed);
  const auto any = [&] {
    return std::next(corpus.begin(), static_cast<std::ptrdiff_t>(mutator.below(corpus.size())));
  };
  const auto sample = any(), other = any();
  input = mutator.spoiled(sample->second, other->second);
  input_seed = seed;
  try {
    const Scene scene = read(sample->first, mutator.below(2) == 0);
    check_scene(scene, mutator.below(8) == 0);
    return true;
  } catch (const InvalidInput& refusal) {
    check_refusal(refusal.what());
    return false;
  } catch (const std::exception& error) {
    fail(fmt::format("an exception that is no InvalidInput: {}", error.what()));
  }
}

int fuzz(std::uint64_t count, std::uint64_t seed) {
  show_input_at_death();
  for (const auto& [name, text] : corpus) {
    input = text;
    read(name, false);  // throws unless it is good as it stands
  }
  std::uint64_t accepted = 0;
  for (std::uint64_t i = 0; i < count; ++i) accepted += try_one(seed + i);
  fmt::print("{} inputs, {} scenes accepted, {} refused\n", count, accepted, count - accepted);
  return 0;
}

}  // namespace
}  // namespace qddot

int main(int argc, char** argv) {
  CLI::App app("Reads spoiled scene and mesh files.", "fuzz_scenes");
  std::uint64_t count = 10'000, seed = 1;
  app.add_option("--count", count, "number of inputs")->capture_default_str();
  app.add_option("--seed", seed, "the seed of the first input; each later one has the next number")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return qddot::fuzz(count, seed);
}
