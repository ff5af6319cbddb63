#pragma once

#include <memory>
#include <string>

#include "experiments/kit/overwriting.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/scene/scene_file.hpp"

namespace qddot::simulate {

// A place for the scene that is asked for (--write-scene), taken before anything else is done.
class WrittenScene {
 public:
  explicit WrittenScene(const std::string& path) {
    if (!path.empty()) file_ = std::make_unique<kit::WholeFile>(path);
  }
  void commit(const Scene& scene) {
    if (!file_) return;
    file_->write(kit::signed_text(to_toml(scene)));
    file_->commit();
  }

 private:
  std::unique_ptr<kit::WholeFile> file_;
};

}  // namespace qddot::simulate
