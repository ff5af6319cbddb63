#pragma once

#include <hdf5.h>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace qddot::motion_files::hdf5 {

// Thrown when a call of HDF5 fails; what() is the operating system's reason if known.
class Failure : public std::runtime_error {
 public:
  Failure();
};

// Returns the result of a call of HDF5; throws Failure if it failed.
template <class Status>
Status checked(Status status) {
  if (status < 0) throw Failure();
  return status;
}

// An object of HDF5, which `let_go` releases.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*let_go)(hid_t)) : id_(checked(id)), close_(let_go) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  // Releases the object now; writing its remaining data to the disk may fail.
  void close() {
    if (id_ >= 0) checked(close_(std::exchange(id_, -1)));
  }
  hid_t id() const { return id_; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

// Stops HDF5 from printing errors of the calling thread and from acting at the process's end. Must
// be called before any other function of HDF5.
void be_quiet();

// Creates a file of HDF5 1.10's format, replacing any other; HDF5 does not lock it.
Handle new_file(const std::string& path);
Handle new_group(const Handle& parent, const std::string& name);
Handle new_properties(hid_t kind);
// A space of that size, which may grow along its first dimension.
Handle new_space(const std::vector<hsize_t>& size, bool may_grow = false);
Handle new_dataset(const Handle& parent, const std::string& name, hid_t type, const Handle& space,
                   const Handle& properties);

// Makes datasets with these properties shuffle their chunks and then deflate them.
void pass_filters(const Handle& properties);

// Writes a dataset of whole numbers or of times, all at once.
void write(const Handle& parent, const std::string& name, const std::vector<std::int64_t>& values,
           std::size_t columns = 1);
void write(const Handle& parent, const std::string& name, const std::vector<double>& values);
void write_attribute(const Handle& object, const std::string& name,
                     const std::vector<std::int64_t>& values);
void write_attribute(const Handle& object, const std::string& name, std::int64_t value);
// An ASCII string of fixed length.
void write_attribute(const Handle& object, const std::string& name, const std::string& text);

}  // namespace qddot::motion_files::hdf5
