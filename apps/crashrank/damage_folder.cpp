#include "damage_folder.hpp"

#include "console.hpp"
#include "streams.hpp"

#include "crashrank/report/damage_model.hpp"
#include "crashrank/report/escape.hpp"
#include "crashrank/report/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

namespace fs = std::filesystem;

Status write_file(const fs::path& path, const std::string& bytes) {
  Result<OutputFile> out = OutputFile::open(path.string(), false);
  if (!out) return out.error();
  out->write(bytes);
  return out->close();
}

Status write_body(const fs::path& stem, const TriangleMesh& mesh, const BodyDamage& damage) {
  const Result<std::string> glb = damage_glb(mesh, damage.triangles);
  if (!glb) return glb.error();
  if (Status written = write_file(stem.string() + ".glb", *glb); !written) return written;
  return write_file(stem.string() + ".ply", damage_ply(mesh, damage.triangles));
}

Status write_picture(const fs::path& path, View<const PictureBody> bodies, double azimuth_deg) {
  PictureOptions options;
  options.azimuth_deg = azimuth_deg;
  const Result<Image> image = draw_picture(bodies, options);
  if (!image) return image.error();
  const Result<std::string> bytes = png(*image);
  if (!bytes) return bytes.error();
  return write_file(path, *bytes);
}

Status write_candidate(const fs::path& stem, const Scenario& scenario, View<const Model> models,
                       const CandidateResult& ranked) {
  const TriangleMesh& ego = models[scenario.ego.model].mesh;
  if (Status written = write_body(stem.string() + "-ego", ego, ranked.ego); !written) {
    return written;
  }
  std::vector<PictureBody> bodies{{&ego, ranked.contacts.front().ego.pose, ranked.ego.triangles}};
  for (std::size_t i = 0; i < ranked.contacts.size(); ++i) {
    const Contact& contact = ranked.contacts[i];
    const ScenarioActor& actor = scenario.actors[contact.actor];
    const TriangleMesh& mesh = models[actor.model].mesh;
    const std::string name =
        fmt::format("{}-{}-{}", stem.string(), i + 1, escape_file_name(actor.name));
    if (Status written = write_body(name, mesh, contact.other); !written) return written;
    bodies.push_back({&mesh, contact.other.pose, contact.other.triangles});
  }
  const double side = azimuth_of_damage_deg(bodies.front());
  Status drawn = write_picture(stem.string() + "-ego.png", {bodies.data(), 1}, side + 35.0);
  if (!drawn) return drawn;
  return write_picture(stem.string() + ".png", bodies, side + 60.0);
}

}  // namespace

Status write_damage(const std::string& folder, std::size_t top, const Scenario& scenario,
                    View<const Model> models, const RankResult& result) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (!fs::is_directory(folder)) {
    return Error{ErrorCode::not_found, folder, {}, "cannot make this folder", {}};
  }
  const auto colliding = static_cast<std::size_t>(
      std::count_if(result.ranking.begin(), result.ranking.end(),
                    [](const CandidateResult& ranked) { return !ranked.contacts.empty(); }));
  const std::size_t wanted = top == 0 ? colliding : std::min(top, colliding);
  std::size_t written = 0;
  Progress progress("drawing", wanted);
  for (std::size_t place = 0; written < wanted; ++place) {
    const CandidateResult& ranked = result.ranking[place];
    if (ranked.contacts.empty()) continue;
    const std::string name = escape_file_name(result.candidates[ranked.candidate].name);
    const fs::path stem = fs::path(folder) / fmt::format("{:03}-{}", place + 1, name);
    if (Status done = write_candidate(stem, scenario, models, ranked); !done) return done;
    progress.update(++written);
  }
  return Success{};
}

}  // namespace crashrank::cli
