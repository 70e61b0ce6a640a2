// Where the data files of the installation are: robots, scenes, schemas.
#pragma once

#include <string>

namespace lfd {

/// The path of a data file given by name or by path. A name without a slash that is no file here is looked up as
/// FOLDER/NAME.json in $LFDTOOLS_SHARE, beside the program (../share/lfdtools) and where the library was built from.
/// @param folder  "robots" or "scenes"
/// @throws Error(Fault::no_input) [input.not_found] that says where it looked
[[nodiscard]] std::string find_data_file(const std::string& name, const std::string& folder);

}  // namespace lfd
