// All programs of the wheel in one: it is the one by whose name it is called, or that its first
// argument names.
#include <cstdio>
#include <each_program.hpp>  // QDDOT_EACH_PROGRAM, by CMake
#include <string_view>

#define QDDOT_DECLARE(name) int main_of_##name(int argc, char** argv);
QDDOT_EACH_PROGRAM(QDDOT_DECLARE)

namespace {

struct Entry {
  std::string_view name;
  int (*main)(int, char**);
};
#define QDDOT_ENTRY(name) {#name, main_of_##name},
constexpr Entry entries[] = {QDDOT_EACH_PROGRAM(QDDOT_ENTRY)};

std::string_view file_name(std::string_view path) { return path.substr(path.rfind('/') + 1); }

}  // namespace

int main(int argc, char** argv) {
  for (int skipped = 0; skipped < 2 && skipped < argc; ++skipped) {
    for (const Entry& entry : entries) {
      if (entry.name == file_name(argv[skipped])) return entry.main(argc - skipped, argv + skipped);
    }
  }
  std::fputs("qddot: name a program; there are", stderr);
  for (const Entry& entry : entries) std::fprintf(stderr, " %s", entry.name.data());
  std::fputs("\n", stderr);
  return 2;
}
