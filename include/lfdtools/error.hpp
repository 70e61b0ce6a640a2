// Named failures. The library throws them with the place of the fault; only the cli layer catches.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace lfd {

/// What went wrong, in the terms of the exit status (sysexits numbering).
enum class Fault : int {
  gate = 1,            ///< refused by a quality or safety gate
  usage = 64,          ///< wrong command line
  data = 65,           ///< bad data or model
  no_input = 66,       ///< input cannot be opened
  internal = 70,       ///< a defect of ours
  memory = 71,         ///< out of memory
  cannot_create = 73,  ///< output cannot be created
  io = 74,             ///< read or write failed
  config = 78          ///< bad robot or scene file
};

/// Where in the input a fault lies. Empty or zero members are unknown.
struct Place {
  std::string file;        ///< name as the user gave it, "<stdin>" for a pipe
  std::size_t line = 0;    ///< from 1
  std::size_t column = 0;  ///< from 1, in bytes (CSV)
  std::string pointer;     ///< JSON pointer such as /covariances/2
};

/// Base of all failures: one sentence in lower case without a full stop, a stable id (lower-case words joined by dots
/// and underscores), and the place.
class Error : public std::runtime_error {
 public:
  Error(Fault fault, std::string id, const std::string& text, Place place = {})
      : std::runtime_error(text), fault_(fault), id_(std::move(id)), place_(std::move(place)) {}

  [[nodiscard]] Fault fault() const noexcept { return fault_; }
  [[nodiscard]] const std::string& id() const noexcept { return id_; }
  [[nodiscard]] const Place& place() const noexcept { return place_; }

 private:
  Fault fault_;
  std::string id_;
  Place place_;
};

/// An option or argument that cannot be taken (exit 64).
struct UsageError : Error {
  UsageError(std::string id, const std::string& text) : Error(Fault::usage, std::move(id), text) {}
};

/// Data or a model that cannot be used (exit 65).
struct DataError : Error {
  DataError(std::string id, const std::string& text, Place place = {})
      : Error(Fault::data, std::move(id), text, std::move(place)) {}
};

/// A robot or scene file that cannot be used (exit 78).
struct ConfigError : Error {
  ConfigError(std::string id, const std::string& text, Place place = {})
      : Error(Fault::config, std::move(id), text, std::move(place)) {}
};

}  // namespace lfd
