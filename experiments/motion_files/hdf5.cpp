#include "experiments/motion_files/hdf5.hpp"

#include <cstdint>

namespace qddot::motion_files::hdf5 {
namespace {

// HDF5's account of its last failure, innermost call first: the first sentence, or the system's
// own words in "..., error message = 'No space left on device', ...".
std::string reason() {
  std::string found;
  const H5E_walk2_t look = [](unsigned, const H5E_error2_t* error, void* to) -> herr_t {
    auto& words = *static_cast<std::string*>(to);
    if (words.empty() && error->desc) words = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, look, &found);
  H5Eclear2(H5E_DEFAULT);
  constexpr std::string_view before = "error message = '";
  const std::size_t start = found.find(before);
  if (start == found.npos) return found.empty() ? "HDF5 failed" : found;
  const std::size_t first = start + before.size();
  return found.substr(first, found.find('\'', first) - first);
}

// The number of rows in a chunk; smaller sets have no chunks.
constexpr std::size_t chunk_rows = 1 << 14;

template <class Value>
void write_all(const Handle& parent, const std::string& name, hid_t type,
               const std::vector<Value>& values, std::size_t columns) {
  std::vector<hsize_t> size = {values.size() / columns};
  if (columns > 1) size.push_back(columns);
  const Handle space = new_space(size), properties = new_properties(H5P_DATASET_CREATE);
  if (size[0] > chunk_rows) {
    std::vector<hsize_t> chunk = size;
    chunk[0] = chunk_rows;
    checked(H5Pset_chunk(properties.id(), static_cast<int>(chunk.size()), chunk.data()));
    pass_filters(properties);
  }
  const Handle set = new_dataset(parent, name, type, space, properties);
  if (!values.empty())
    checked(H5Dwrite(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
}

void put_attribute(const Handle& object, const std::string& name, hid_t type, const Handle& space,
                   const void* value) {
  const Handle attribute(
      H5Acreate2(object.id(), name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  checked(H5Awrite(attribute.id(), type, value));
}

}  // namespace

Failure::Failure() : std::runtime_error(reason()) {}

Handle new_properties(hid_t kind) { return {H5Pcreate(kind), H5Pclose}; }

void be_quiet() {
  // Without this, HDF5 retries at the process's end to write data that a full disk refused.
  H5dont_atexit();
  checked(H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr));
}

Handle new_file(const std::string& path) {
  const Handle access = new_properties(H5P_FILE_ACCESS);
  checked(H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110));
  // The file is already locked (see WholeFile), and HDF5's own lock would conflict.
  checked(H5Pset_file_locking(access.id(), false, true));
  return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose};
}

Handle new_group(const Handle& parent, const std::string& name) {
  return {H5Gcreate2(parent.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose};
}

Handle new_space(const std::vector<hsize_t>& size, bool may_grow) {
  std::vector<hsize_t> most = size;
  if (may_grow) most[0] = H5S_UNLIMITED;
  return {H5Screate_simple(static_cast<int>(size.size()), size.data(), most.data()), H5Sclose};
}

Handle new_dataset(const Handle& parent, const std::string& name, hid_t type, const Handle& space,
                   const Handle& properties) {
  return {H5Dcreate2(parent.id(), name.c_str(), type, space.id(), H5P_DEFAULT, properties.id(),
                     H5P_DEFAULT),
          H5Dclose};
}

void pass_filters(const Handle& properties) {
  checked(H5Pset_shuffle(properties.id()));
  checked(H5Pset_deflate(properties.id(), 1));
}

void write(const Handle& parent, const std::string& name, const std::vector<std::int64_t>& values,
           std::size_t columns) {
  write_all(parent, name, H5T_STD_I64LE, values, columns);
}

void write(const Handle& parent, const std::string& name, const std::vector<double>& values) {
  write_all(parent, name, H5T_IEEE_F64LE, values, 1);
}

void write_attribute(const Handle& object, const std::string& name,
                     const std::vector<std::int64_t>& values) {
  put_attribute(object, name, H5T_STD_I64LE, new_space({values.size()}), values.data());
}

void write_attribute(const Handle& object, const std::string& name, std::int64_t value) {
  put_attribute(object, name, H5T_STD_I64LE, Handle(H5Screate(H5S_SCALAR), H5Sclose), &value);
}

void write_attribute(const Handle& object, const std::string& name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  checked(H5Tset_size(type.id(), text.size()));
  checked(H5Tset_strpad(type.id(), H5T_STR_NULLPAD));
  put_attribute(object, name, type.id(), Handle(H5Screate(H5S_SCALAR), H5Sclose), text.data());
}

}  // namespace qddot::motion_files::hdf5
