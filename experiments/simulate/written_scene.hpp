#pragma once

#include <memory>
#include <string>

#include "experiments/command/overwriting.hpp"
#include "experiments/command/whole_file.hpp"
#include "qddot/scene/scene_writer.hpp"

namespace qddot::simulate {

// A place for the scene that is asked for (--write-scene), taken before anything else is done.
class WrittenScene {
 public:
  explicit WrittenScene(const std::string& path) {
    if (!path.empty()) file_ = std::make_unique<command::WholeFile>(path);
  }
  void commit(const Scene& scene) {
    if (!file_) return;
    file_->write(command::signed_text(to_toml(scene)));
    file_->commit();
  }

 private:
  std::unique_ptr<command::WholeFile> file_;
};

}  // namespace qddot::simulate
