#include "damage_folder.hpp"

#include "console.hpp"
#include "streams.hpp"

#include "crashrank/report/damage_model.hpp"
#include "crashrank/report/escape.hpp"
#include "crashrank/report/picture.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

namespace fs = std::filesystem;

// Who writes into a folder wants the file to be in that folder.
constexpr OutputKind glb_file{"a GLB mesh", "glTF", false};
constexpr OutputKind ply_file{"a PLY mesh", "ply\n", false};
constexpr OutputKind png_file{"a PNG picture", "\x89PNG", false};

/// A candidate whose damage is written.
struct Picked {
  const CandidateResult* ranked;
  std::string stem;  ///< of its files, with the folder
};

std::vector<Picked> pick(const DamageOptions& options, const RankResult& result) {
  std::vector<Picked> picked;
  for (std::size_t place = 0; place < result.ranking.size(); ++place) {
    const CandidateResult& ranked = result.ranking[place];
    if (ranked.contacts.empty()) continue;
    if (options.top > 0 && picked.size() == options.top) break;
    const std::string name = escape_file_name(result.candidates[ranked.candidate].name);
    picked.push_back(
        {&ranked, fs::path(options.folder) / fmt::format("{:03}-{}", place + 1, name)});
  }
  return picked;
}

std::string ego_stem(const Picked& picked) { return picked.stem + "-ego"; }

std::string other_stem(const Picked& picked, std::size_t contact, const Scenario& scenario) {
  const ScenarioActor& actor = scenario.actors[picked.ranked->contacts[contact].actor];
  return fmt::format("{}-{}-{}", picked.stem, contact + 1, escape_file_name(actor.name));
}

Status check_file(const std::string& path, const OutputKind& kind, const DamageOptions& options) {
  if (same_place(path, options.report)) {
    return Error{ErrorCode::usage,
                 path,
                 {},
                 "is a file of --damage and the one of --report",
                 "name another file with --report"};
  }
  return can_be_written(path, kind, options.inputs, options.folder);
}

Status check_files(const Picked& picked, const Scenario& scenario, const DamageOptions& options) {
  std::vector<std::string> bodies{ego_stem(picked)};
  for (std::size_t i = 0; i < picked.ranked->contacts.size(); ++i) {
    bodies.push_back(other_stem(picked, i, scenario));
  }
  for (const std::string& body : bodies) {
    if (Status sound = check_file(body + ".glb", glb_file, options); !sound) return sound;
    if (Status sound = check_file(body + ".ply", ply_file, options); !sound) return sound;
  }
  for (const std::string& picture : {ego_stem(picked), picked.stem}) {
    if (Status sound = check_file(picture + ".png", png_file, options); !sound) return sound;
  }
  return Success{};
}

Status write_file(const std::string& path, const OutputKind& kind, const std::string& bytes) {
  Result<OutputFile> out = OutputFile::open(path, kind);
  if (!out) return out.error();
  out->write(bytes);
  return out->close();
}

Status write_body(const std::string& stem, const TriangleMesh& mesh, const BodyDamage& damage) {
  const Result<std::string> glb = damage_glb(mesh, damage.triangles);
  if (!glb) return glb.error();
  if (Status written = write_file(stem + ".glb", glb_file, *glb); !written) return written;
  return write_file(stem + ".ply", ply_file, damage_ply(mesh, damage.triangles));
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

Status write_picture(const std::string& path, View<const PictureBody> bodies, double azimuth_deg) {
  const Result<double> best = best_azimuth_deg(bodies, azimuth_deg);
  if (!best) return best.error();
  PictureOptions options;
  options.azimuth_deg = *best;
  const Result<Image> image = draw_picture(bodies, options);
  if (!image) return image.error();
  const Result<std::string> bytes = png(*image);
  if (!bytes) return bytes.error();
  return write_file(path, png_file, *bytes);
}

Status write_candidate(const Picked& picked, const Scenario& scenario, View<const Model> models) {
  const CandidateResult& ranked = *picked.ranked;
  const TriangleMesh& ego = models[scenario.ego.model].mesh;
  if (Status written = write_body(ego_stem(picked), ego, ranked.ego); !written) {
    return written;
  }
  std::vector<PictureBody> bodies{{&ego, ranked.contacts.front().ego.pose, ranked.ego.triangles}};
  for (std::size_t i = 0; i < ranked.contacts.size(); ++i) {
    const Contact& contact = ranked.contacts[i];
    const TriangleMesh& mesh = models[scenario.actors[contact.actor].model].mesh;
    const std::string stem = other_stem(picked, i, scenario);
    if (Status written = write_body(stem, mesh, contact.other); !written) return written;
    bodies.push_back({&mesh, contact.other.pose, contact.other.triangles});
  }
  const double side = azimuth_of_damage_deg(bodies.front());
  Status drawn = write_picture(ego_stem(picked) + ".png", {bodies.data(), 1}, side);
  if (!drawn) return drawn;
  return write_picture(picked.stem + ".png", bodies, side);
}

Error cannot_make(const std::string& folder, const std::string& why) {
  return Error{ErrorCode::not_found,
               folder,
               {},
               "cannot make this folder: " + why,
               "name a new folder, or one that can be written to"};
}

}  // namespace

Status check_damage_folder(const DamageOptions& options) {
  if (same_place(options.folder, options.report)) {
    return Error{ErrorCode::usage,
                 options.report,
                 {},
                 "is the folder of --damage",
                 "name another file with --report"};
  }
  std::error_code failure;
  fs::path there = fs::absolute(options.folder, failure);
  while (!fs::exists(there, failure) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, failure)) {
    return cannot_make(options.folder, "a file has its name, or that of a folder above");
  }
  if (access(there.c_str(), W_OK | X_OK) == 0) return Success{};
  return cannot_make(options.folder, strerror(errno));
}

Status write_damage(const DamageOptions& options, const Scenario& scenario,
                    View<const Model> models, const RankResult& result) {
  const std::vector<Picked> picked = pick(options, result);
  for (const Picked& one : picked) {
    if (Status sound = check_files(one, scenario, options); !sound) return sound;
  }
  std::error_code failure;
  fs::create_directories(options.folder, failure);
  std::error_code ignored;
  if (!fs::is_directory(options.folder, ignored)) {
    return cannot_make(options.folder, failure.message());
  }
  std::size_t written = 0;
  Progress progress("drawing", picked.size());
  for (const Picked& one : picked) {
    if (Status done = write_candidate(one, scenario, models); !done) return done;
    progress.update(++written);
  }
  return Success{};
}

}  // namespace crashrank::cli
