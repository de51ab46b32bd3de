#include "crashrank/model/model.hpp"

#include "crashrank/internal/base/guarded.hpp"
#include "model/file_bytes.hpp"
#include "model/model_layout.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

namespace crashrank {

Result<LoadedModel> load_model(const std::string& path, const LoadModelOptions& options) {
  return detail::guarded([&]() -> Result<LoadedModel> {
    Result<detail::FileBytes> file = detail::file_bytes(path, options);
    if (!file) return file.error();
    Result<LoadedModel> loaded = detail::decode_model(file->bytes, file->keeper, true);
    if (!loaded) loaded.error().file = path;
    return loaded;
  });
}

Result<LoadedModel> load_model(View<const unsigned char> bytes,
                               std::shared_ptr<const void> keeper) {
  return detail::guarded([&]() -> Result<LoadedModel> {
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % detail::section_alignment != 0) {
      return make_error(ErrorCode::usage, "the bytes of a model begin at a multiple of 64");
    }
    // Memory that lives for ever needs no keeper, a column does.
    if (keeper == nullptr) keeper.reset(bytes.data(), [](const void*) {});
    return detail::decode_model(bytes, keeper, true);
  });
}

Status save_model(const StoredModel& stored, const std::string& path, bool overwrite) {
  return detail::guarded([&]() -> Status {
    const Result<std::vector<unsigned char>> bytes = encode_model(stored);
    if (!bytes) {
      Error error = bytes.error();
      error.file = path;
      return error;
    }
    return detail::write_whole(path, *bytes, overwrite);
  });
}

bool is_model_file(const std::string& path) {
  constexpr std::string_view extension = ".crm";
  const auto same = [](char p, char q) { return p == std::tolower(static_cast<unsigned char>(q)); };
  const bool named =
      path.size() > extension.size() &&
      std::equal(extension.begin(), extension.end(), path.end() - extension.size(), same);
  return named ||
         detail::begins_with(path, {detail::model_magic.data(), detail::model_magic.size()});
}

}  // namespace crashrank
