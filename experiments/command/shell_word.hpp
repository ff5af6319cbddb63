#pragma once

#include <string>

namespace qddot::command {

// One word of a shell's command: quoted where a shell would read it as something else.
std::string shell_word(const std::string& word);

}  // namespace qddot::command
