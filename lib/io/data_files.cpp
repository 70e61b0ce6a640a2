#include "lfdtools/io/data_files.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "lfdtools/error.hpp"

namespace lfd {

std::string find_data_file(const std::string& name, const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const bool named_as_file = name.find('/') != std::string::npos || name.ends_with(".json") ||
                             name.ends_with(".yaml") || name.ends_with(".yml") || name.ends_with(".urdf");
  if (named_as_file || fs::is_regular_file(name, ignored)) return name;
  std::vector<fs::path> roots;
  if (const char* share = std::getenv("LFDTOOLS_SHARE")) roots.emplace_back(share);
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  if (!program.empty()) roots.push_back(program.parent_path().parent_path() / "share" / "lfdtools");
  roots.emplace_back(LFD_SHARE_DIR);
  std::string looked;
  for (const auto& root : roots) {
    const fs::path path = root / folder / (name + ".json");
    if (fs::is_regular_file(path, ignored)) return path.string();
    looked += (looked.empty() ? "" : ", ") + path.string();
  }
  throw Error(Fault::no_input, "input.not_found",
              fmt::format("there is no '{}' in {} (looked for {})", name, folder, looked));
}

}  // namespace lfd
