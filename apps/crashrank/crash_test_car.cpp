#include "crash_test_car.hpp"

#include "crash_test_prism.hpp"
#include "json.hpp"
#include "streams.hpp"

#include "crashrank/mesh/import.hpp"

#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

}  // namespace

Result<std::string> find_rig_car() {
  constexpr const char* name = "models/sedan.obj";
  std::error_code error;
  std::vector<fs::path> starts;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (!error) starts.push_back(self.parent_path());
  const fs::path here = fs::current_path(error);
  if (!error) starts.push_back(here);
  for (const fs::path& start : starts) {
    for (fs::path folder = start;; folder = folder.parent_path()) {
      for (const char* data : {"data", "share/crashrank"}) {
        const fs::path path = folder / data / name;
        if (fs::is_regular_file(path, error)) return path.string();
      }
      if (folder == folder.parent_path()) break;
    }
  }
  return make_error(ErrorCode::not_found, "data/models/sedan.obj is not found",
                    "name a car with --car");
}

Result<RigCar> load_rig_car(const std::string& path) {
  constexpr std::size_t most_bytes = std::size_t{4} << 20U;
  const fs::path list = fs::path(path).parent_path() / "models.json";
  const Result<std::string> text = read_text(list.string(), most_bytes);
  if (!text) return text.error();
  const auto refuse = [&](const std::string& reason) {
    Error error = make_error(ErrorCode::bad_input, reason, "see data/models/models.json");
    error.file = list.string();
    return error;
  };
  const Json document = Json::parse(*text, nullptr, false);
  if (!document.is_object() || !document.contains("models") || !document["models"].is_array()) {
    return refuse("is no list of models");
  }
  RigCar car;
  for (const Json& entry : document["models"]) {
    if (!entry.is_object() || entry.value("file", "") != fs::path(path).filename().string()) {
      continue;
    }
    car.wheelbase_m = entry.value("wheelbase_m", 0.0);
    car.width_m = entry.value("width_m", 0.0);
    if (!(car.wheelbase_m > 0.0) || !(car.width_m > 0.0)) break;
  }
  if (!(car.wheelbase_m > 0.0)) return refuse("has no measures of " + path);
  Result<ImportedMesh> imported = import_mesh(path, {});
  if (!imported) return imported.error();
  car.mesh = std::move(imported->mesh);
  return car;
}

TriangleMesh stretched_car(const RigCar& car, const CarSize& size) {
  TriangleMesh mesh = car.mesh;
  const Box box = mesh.bounds();
  const double front_m = static_cast<double>(box.max.x()) - car.wheelbase_m;
  const double rear_m = -static_cast<double>(box.min.x());
  const double overhangs_m = size.length_m - size.wheelbase_m;
  const double alike = overhangs_m / (front_m + rear_m);
  const double rear = size.rear_overhang_m ? *size.rear_overhang_m / rear_m : alike;
  const double front =
      size.rear_overhang_m ? (overhangs_m - *size.rear_overhang_m) / front_m : alike;
  const double across = size.width_m / car.width_m;
  const double up = size.height_m / static_cast<double>(box.max.z());
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    Vector3d p = vertex.cast<double>();
    if (p.x() < 0.0) {
      p.x() *= rear;
    } else if (p.x() > car.wheelbase_m) {
      p.x() = size.wheelbase_m + (p.x() - car.wheelbase_m) * front;
    } else {
      p.x() *= size.wheelbase_m / car.wheelbase_m;
    }
    p.y() *= across;
    p.z() *= up;
    vertex = p.cast<float>();
  }
  return mesh;
}

TriangleMesh car_box(const TriangleMesh& car, double width_m) {
  const Box box = car.bounds();
  Vector3d least = box.min.cast<double>();
  Vector3d greatest = box.max.cast<double>();
  least.y() = -0.5 * width_m;
  greatest.y() = 0.5 * width_m;
  return box_prism(least, greatest);
}

}  // namespace crashrank::cli
