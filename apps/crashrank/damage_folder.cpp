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

// Of a few places around the scene the one from which a small picture shows most damage; what
// leads is asked first and keeps its place when no other shows a tenth more.
Result<double> best_azimuth_deg(View<const PictureBody> bodies, double azimuth_deg) {
  double best = azimuth_deg;
  double most = -1.0;
  for (const double turn : {35.0, -35.0, 70.0, -70.0, 110.0, -110.0, 150.0, -150.0}) {
    PictureOptions options;
    options.width_px = 240;
    options.height_px = 150;
    options.azimuth_deg = azimuth_deg + turn;
    const Result<Image> image = draw_picture(bodies, options);
    if (!image) return image.error();
    const double red = static_cast<double>(count_damage(*image));
    if (red > 1.1 * most) {
      most = red;
      best = options.azimuth_deg;
    }
  }
  return best;
}

Status write_picture(const fs::path& path, View<const PictureBody> bodies, double azimuth_deg) {
  const Result<double> best = best_azimuth_deg(bodies, azimuth_deg);
  if (!best) return best.error();
  PictureOptions options;
  options.azimuth_deg = *best;
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
  Status drawn = write_picture(stem.string() + "-ego.png", {bodies.data(), 1}, side);
  if (!drawn) return drawn;
  return write_picture(stem.string() + ".png", bodies, side);
}

}  // namespace

Status make_folder(const std::string& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  std::error_code ignored;
  if (fs::is_directory(folder, ignored)) return Success{};
  const bool taken = fs::exists(folder, ignored);
  return Error{ErrorCode::not_found,
               folder,
               {},
               "cannot make this folder: " +
                   (taken ? std::string("a file has its name") : failure.message()),
               "name a new folder, or one that can be written to"};
}

Status write_damage(const std::string& folder, std::size_t top, const Scenario& scenario,
                    View<const Model> models, const RankResult& result) {
  if (Status made = make_folder(folder); !made) return made;
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
