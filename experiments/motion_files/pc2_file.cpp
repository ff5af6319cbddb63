#include <bit>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/csv.hpp"
#include "experiments/kit/whole_file.hpp"
#include "experiments/motion_files/frame.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::motion_files {
namespace {

using kit::WholeFile;

constexpr std::size_t most_points = std::numeric_limits<std::int32_t>::max();

// The file's first 32 bytes.
std::string header(std::size_t points, std::size_t frames) {
  static_assert(std::endian::native == std::endian::little, "numbers are written as they are");
  std::string text("POINTCACHE2", 12);
  const auto add = [&](auto value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  add(std::int32_t(1));  // version
  add(static_cast<std::int32_t>(points));
  add(0.0F);  // the first sample's frame
  add(1.0F);  // frames from sample to sample
  add(static_cast<std::int32_t>(frames));
  return text;
}

// `nodes`: the nodes at the start of the motion, where massless ones are not as drawn.
std::string obj_text(const Scene& start, const std::vector<Node>& nodes) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  // Nine digits read back as the same 32-bit float.
  for (const Node& node : nodes)
    fmt::format_to(out, "v {:.9g} {:.9g} {:.9g}\n", node.position[0], node.position[1],
                   node.position[2]);
  for (const auto& [a, b, c] : start.faces)
    fmt::format_to(out, "f {} {} {}\n", a + 1, b + 1, c + 1);
  for (const Spring& spring : start.springs)
    fmt::format_to(out, "l {} {}\n", spring.nodes[0] + 1, spring.nodes[1] + 1);
  return kit::signed_text(fmt::to_string(text));
}

class Pc2File final : public MotionFile {
 public:
  Pc2File(const std::vector<std::string>& files, const Scene& start, Framing framing)
      : framing_(std::move(framing)),
        points_(start.nodes.size()),
        file_(files[0], {}, files[2]),
        obj_(files[1]),
        sidecar_(files[2]) {
    file_.write(header(points_, 0));
    obj_.write(obj_text(start, framing_.nodes()));
  }

  bool add(const State& state, const State*) override {
    const Frame* frame = frames_ == most_points ? nullptr : framing_.of(state, nullptr);
    if (!frame) return false;
    file_.write({reinterpret_cast<const char*>(frame->positions.data()),
                 sizeof(float) * frame->positions.size()});
    ++frames_;
    return true;
  }

  void complete(const nlohmann::json& origin) override {
    file_.overwrite_beginning(header(points_, frames_));
    sidecar_.write(kit::text_of_sidecar(origin));
    for (WholeFile* file : {&file_, &obj_, &sidecar_}) file->complete();
  }

  void commit() override {
    for (WholeFile* file : {&file_, &obj_, &sidecar_}) file->commit();
  }

 private:
  Framing framing_;
  std::size_t points_, frames_ = 0;
  WholeFile file_, obj_, sidecar_;
};

}  // namespace

std::unique_ptr<MotionFile> open_pc2(const std::string& path, const Scene& start, Framing framing) {
  if (start.nodes.size() > most_points)
    throw InvalidInput(fmt::format("{}: the scene has {} nodes; a .pc2 has {} points at most", path,
                                   start.nodes.size(), most_points));
  return std::make_unique<Pc2File>(files_of_motion(path, "motion"), start, std::move(framing));
}

}  // namespace qddot::motion_files
