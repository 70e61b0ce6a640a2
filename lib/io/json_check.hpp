// Checks that model files share.
#pragma once

#include <string>

#include "lfdtools/error.hpp"
#include "lfdtools/io/json.hpp"

namespace lfd {

/// Runs a check of the library that knows no files; its refusal is thrown again with this value's place, and with the
/// fault that the document asks for.
template <class Check>
void checked(const JsonView& at, Check check) {
  std::string id;
  std::string text;
  try {
    check();
    return;
  } catch (const DataError& error) {
    id = error.id();
    text = error.what();
  } catch (const ConfigError& error) {
    id = error.id();
    text = error.what();
  }
  at.fail(id, text);
}

/// Refuses a matrix whose halves differ by more than 1e-9 of what its diagonal allows.
void require_symmetric(const JsonView& at, const Matrix& A, const char* id);

}  // namespace lfd
