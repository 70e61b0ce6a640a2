// The methods that can be judged, by name.
#pragma once

#include <string>
#include <vector>

#include "lfdtools/prediction.hpp"

namespace lfd {

struct Method {
  std::string name;
  std::string meaning;  ///< for --help and the manual
  bool simple = false;  ///< an opponent that any skill must beat: line, nearest, mean, affine in their forms
  Needs needs;
  Trainer train;
  std::string same_as;  ///< the method that this one is by another name today; empty: none
};

/// All of them, in the order of tables.
[[nodiscard]] const std::vector<Method>& methods();

/// Those named, in the order named; all for an empty list.
/// @throws UsageError [validation.method] for a name that is none
[[nodiscard]] std::vector<const Method*> chosen_methods(const std::vector<std::string>& names);

}  // namespace lfd
