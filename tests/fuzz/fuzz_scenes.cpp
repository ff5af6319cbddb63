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
#include <random>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/scene/same_scene.hpp"

// There where the program is built with a sanitizer.
extern "C" void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));

namespace qddot {
namespace {

// Spoils texts, the same ones in the same way for the same seed.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

  // `text` with one to eight changes. Bytes, ranges, lines, words and numbers are altered,
  // repeated, swapped or left out; parts of `other`, nesting and invalid bytes are inserted.
  std::string spoiled(std::string text, const std::string& other) {
    constexpr std::size_t longest = 20'000;
    // Half of them with a single change, so that more than a few remain readable.
    for (std::size_t changes = 1 + below(below(2) ? 1 : 8); changes > 0; --changes) {
      switch (below(4)) {
        case 0:
          change_bytes(text, other);
          break;
        case 1:
          change_words(text);
          break;
        case 2:
          change_lines(text);
          break;
        default:
          text.insert(below(text.size() + 1), insertion());
      }
      text.resize(std::min(text.size(), longest));
    }
    return text;
  }

 private:
  struct Range {
    std::size_t start, size;
  };

  // Lists, whose parts stand between bars.
  static constexpr std::string_view numbers =
      "-1|0|-0|-0.0|1|2|3|nan|-nan|inf|-inf|1e308|-1e308|1.7976931348623157e308|1e309|1e-320|"
      "5e-324|1e-400|99999999999999999999|-99999999999999999999|9223372036854775807|"
      "-9223372036854775808|18446744073709551615|4294967296|2147483648|1000000000|1000|0x10|0b11|"
      "0o7|1_0|01|1.|.5|1e|2024-01-01T00:00:00Z";
  static constexpr std::string_view words =
      "nodes|springs|[[nodes]]\n|[[springs]]\n|[mesh]\n|[generator]\n|[[mesh.pin]]\n|mass = 1\n|"
      "pinned = true\n|quartic = 1\n|rest_length = 0.5\n|start = \"equilibrium\"\n|"
      "bending_stiffness = 1\n|dimension = 1\n|[]|{}|\"\"\"|'''|\\u0000|\\n|\\UFFFFFFFF|\r\n|#|=|"
      "$Nodes\n|$EndNodes\n|$Elements\n|$EndElements\n|4.1|2.2|Vertices|Triangles|Dimension 2\n|"
      "f 1 2 3\n|v 1 2 3\n|load = [1, 0, 0]\n|[[mesh.load]]\n|group = 3\n|density = 2\n|"
      "property list uchar int vertex_indices\n|element face 2\n|facet normal 0 0 1\n";
  static constexpr std::string_view not_text =
      "\xff|\x80|\xc3\x28|\xed\xa0\x80|\xf8\x88\x80\x80\x80|\xef\xbb\xbf|\xc2\x85|\xf4\x90\x80\x80";
  static constexpr std::string_view nestings = "[|{a=|a.|[[|[a.|{a.b=";

  // The parts of a text between bytes of `separators`: its words or its lines.
  static std::vector<Range> parts(std::string_view text, std::string_view separators) {
    std::vector<Range> all;
    for (std::size_t start = 0; start < text.size();) {
      const std::size_t end = std::min(text.find_first_of(separators, start), text.size());
      if (end > start) all.push_back({start, end - start});
      start = end + 1;
    }
    return all;
  }

  static std::vector<Range> number_words(std::string_view text) {
    auto all = parts(text, " \n\t,[]{}=/\"");
    std::erase_if(all, [&](const Range& word) {
      return std::string_view("+-.0123456789").find(text[word.start]) == std::string_view::npos;
    });
    return all;
  }

  std::string_view one_of(std::string_view list) {
    const auto all = parts(list, "|");
    const Range chosen = all[below(all.size())];
    return list.substr(chosen.start, chosen.size);
  }

  void change_bytes(std::string& text, const std::string& other) {
    const std::size_t at = below(text.size() + 1), length = below(below(4) ? 12 : 300);
    switch (below(6)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        return;
      case 1:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        return;
      case 2:
        text.erase(at, length);
        return;
      case 3:
        text.insert(at, text.substr(below(text.size() + 1), length));
        return;
      case 4:
        text.insert(at, other.substr(below(other.size() + 1), length));
        return;
      default:  // the start of the one, the end of the other
        text = text.substr(0, at) + other.substr(below(other.size() + 1));
    }
  }

  static void swap_parts(std::string& text, Range a, Range b) {
    if (a.start > b.start) std::swap(a, b);
    if (a.start + a.size > b.start) return;
    const std::string first = text.substr(a.start, a.size), second = text.substr(b.start, b.size);
    text.replace(b.start, b.size, first);
    text.replace(a.start, a.size, second);
  }

  void change_words(std::string& text) {
    const auto all = below(2) ? number_words(text) : parts(text, " \n\t,[]{}=");
    if (all.empty()) return;
    const Range word = all[below(all.size())], second = all[below(all.size())];
    switch (below(4)) {
      case 0:
        return swap_parts(text, word, second);
      case 1:
        text.replace(word.start, word.size, text.substr(second.start, second.size));
        return;
      default:
        text.replace(word.start, word.size, one_of(numbers));
    }
  }

  void change_lines(std::string& text) {
    const auto all = parts(text, "\n");
    if (all.empty()) return;
    const Range line = all[below(all.size())], second = all[below(all.size())];
    const std::string copy = text.substr(line.start, line.size) + "\n";
    switch (below(4)) {
      case 0:
        return swap_parts(text, line, second);
      case 1:
        text.erase(line.start, line.size + 1);
        return;
      case 2:
        text.insert(second.start, copy);
        return;
      default:
        for (std::size_t times = below(below(8) ? 6 : 200); times > 0; --times)
          text.insert(line.start, copy);
    }
  }

  std::string insertion() {
    switch (below(8)) {
      case 0:
        return std::string(one_of(not_text));
      case 1: {
        const std::string_view nesting = one_of(nestings);
        std::string deep;
        for (std::size_t depth = below(below(8) ? 8 : 4000); depth > 0; --depth) deep += nesting;
        return deep;
      }
      case 2:
        return std::string(one_of(numbers));
      case 3:
        return std::string(1, static_cast<char>(below(256)));
      default:
        return std::string(one_of(words));
    }
  }

  std::mt19937_64 random_;
};

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

// A scene file, or one that takes all that a mesh has; that bends, and has masses of its density.
// Both name their meshes.
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
      "[mesh]\nfile = '{}'\nstiffness = 3\n{} = 2\nbending_stiffness = {}\n"
      "pin = [{{min = [0, 0, 0], max = [1, 0.5, 0]}}]\n",
      name, bends ? "density" : "node_mass", bends ? 1.5 : 0);
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
