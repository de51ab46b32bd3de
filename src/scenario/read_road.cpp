#include "scenario/read_road.hpp"

#include "scenario/key_ranges.hpp"

#include <string>
#include <utility>
#include <vector>

namespace crashrank::detail {
namespace {

using nlohmann::json;
using Ring = std::vector<Eigen::Vector2d>;

/// Reads rings of one road; all its corners together are limited.
class RingReader {
public:
  explicit RingReader(Refusals& refusals) : refusals_(refusals) {}

  Ring read(const json& value, const std::string& path) {
    Ring ring;
    if (!value.is_array()) {
      refuse_at(refusals_, path, "is not a list of corners", "write it as [[x, y], ...]");
      return ring;
    }
    corners_ += value.size();
    if (corners_ > road_limits::corners) {
      refuse_at(refusals_, path,
                "brings the road to more than " + std::to_string(road_limits::corners) + " corners",
                "simplify it", ErrorCode::limit_exceeded);
      return ring;
    }
    for (std::size_t i = 0; i < value.size() && refusals_.goes_on(); ++i) {
      const std::string place = path + "[" + std::to_string(i) + "]";
      const json& corner = value[i];
      if (!corner.is_array() || corner.size() != 2) {
        refuse_at(refusals_, place, "is not a corner", "write it as [x, y]");
        return ring;
      }
      const double x = checked_number(corner[0], place + "[0]", ranges::position, refusals_, 0.0);
      const double y = checked_number(corner[1], place + "[1]", ranges::position, refusals_, 0.0);
      ring.emplace_back(x, y);
    }
    // Rings of other programs often end with their first corner.
    if (ring.size() > 3 && ring.front() == ring.back()) ring.pop_back();
    return ring;
  }

private:
  Refusals& refusals_;
  std::size_t corners_ = 0;
};

Area read_area(const JsonObject& object, RingReader& rings) {
  Area area;
  object.require("outer");
  if (object.has("outer")) area.outer = rings.read(object.at("outer"), object.path_of("outer"));
  if (const json* const holes = object.array("holes", 0, road_limits::holes)) {
    for (std::size_t i = 0; i < holes->size() && object.refusals().goes_on(); ++i) {
      area.holes.push_back(
          rings.read((*holes)[i], object.path_of(ranges::indexed("holes", i).c_str())));
    }
  }
  return area;
}

}  // namespace

Road read_road(const JsonObject& root) {
  Road road;
  if (!root.has("road")) return road;
  const JsonObject object(root.at("road"), "road", root.refusals(),
                          {"drivable", "off_road", "note"});
  if (const json* const areas = object.array("drivable", 1, road_limits::areas)) {
    RingReader rings(root.refusals());
    for (std::size_t i = 0; i < areas->size() && root.refusals().goes_on(); ++i) {
      const std::string path = object.path_of(ranges::indexed("drivable", i).c_str());
      const JsonObject area((*areas)[i], path, root.refusals(), {"outer", "holes"});
      road.drivable.push_back(read_area(area, rings));
    }
  }
  if (object.has("off_road")) {
    const JsonObject off(object.at("off_road"), object.path_of("off_road"), root.refusals(),
                         {"harm_per_leaving", "grip"});
    road.harm_per_leaving = off.number("harm_per_leaving", ranges::harm_per_leaving, 0.0);
    road.off_road_grip = off.optional_number("grip", ranges::grip);
  }
  return road;
}

}  // namespace crashrank::detail
