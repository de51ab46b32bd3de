#include "mesh/importer/request.hpp"

#include "mesh/import_protocol.hpp"

#include <charconv>
#include <map>

namespace crashrank::importer {
namespace {

class Words {
public:
  explicit Words(const std::vector<std::string>& words) {
    for (const std::string& word : words) {
      const std::size_t equals = word.find('=');
      if (equals != std::string::npos) values_[word.substr(0, equals)] = word.substr(equals + 1);
    }
  }

  void take(const char* key, std::string& to) {
    const auto found = values_.find(key);
    if (found == values_.end()) {
      miss(key);
    } else {
      to = found->second;
    }
  }

  template <class Number> void take(const char* key, Number& to) {
    std::string text;
    take(key, text);
    const char* end = text.data() + text.size();
    const std::from_chars_result result = std::from_chars(text.data(), end, to);
    if (result.ec != std::errc() || result.ptr != end) miss(key);
  }

  void take(const char* key, Axis& to) {
    unsigned number = 0;
    take(key, number);
    if (number > 5) miss(key);
    to = static_cast<Axis>(number);
  }

  const std::string& missing() const { return missing_; }

private:
  void miss(const char* key) {
    if (missing_.empty()) missing_ = key;
  }

  std::map<std::string, std::string> values_;
  std::string missing_;
};

}  // namespace

Result<Request> parse_request(const std::vector<std::string>& words) {
  Words given(words);
  Request request;
  std::uint32_t version = 0;
  given.take("version", version);
  given.take("path", request.path);
  given.take("extension", request.extension);
  given.take("seconds", request.seconds);
  given.take("memory_bytes", request.memory_bytes);
  given.take("file_bytes", request.file_bytes);
  given.take("triangles", request.triangles);
  given.take("vertices", request.vertices);
  given.take("parts", request.parts);
  given.take("polygon_corners", request.polygon_corners);
  given.take("name_bytes", request.name_bytes);
  given.take("scale", request.transform.scale);
  given.take("up", request.transform.up);
  given.take("forward", request.transform.forward);
  given.take("origin_x", request.transform.origin_m.x());
  given.take("origin_y", request.transform.origin_m.y());
  given.take("origin_z", request.transform.origin_m.z());
  if (!given.missing().empty()) {
    return make_error(ErrorCode::usage, "no usable value for '" + given.missing() + "'");
  }
  if (version != detail::import_version) {
    return make_error(ErrorCode::usage, "asked for another protocol version");
  }
  if (Status status = check(request.transform); !status) return status.error();
  return request;
}

Error out_of_memory(const Request& request) {
  return make_error(
      ErrorCode::limit_exceeded,
      "reading it takes more memory than it may: " + std::to_string(request.memory_bytes >> 20U) +
          " MiB, or less where the system sets a limit",
      "simplify it if it is large; otherwise it is damaged");
}

}  // namespace crashrank::importer
