#include <algorithm>
#include <regex>

#include "python/extension/bindings.hpp"

namespace qddot::python {

std::string in_python(const std::string& sentence) {
  static const std::regex option("--(no-reduce (?=dimension|massless)|[a-z][a-z-]*[a-z])");
  std::string words;
  auto rest = sentence.begin();
  for (std::sregex_iterator at(sentence.begin(), sentence.end(), option), end; at != end; ++at) {
    std::string name = (*at)[1];
    std::ranges::replace(name, '-', '_');
    words.append(rest, (*at)[0].first);
    words += name == "no_reduce" ? "keep" : name == "no_reduce " ? "keep=" : name;
    rest = (*at)[0].second;
  }
  return words.append(rest, sentence.end());
}

}  // namespace qddot::python
