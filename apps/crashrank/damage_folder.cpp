#include "damage_folder.hpp"

#include "console.hpp"
#include "streams.hpp"

#include "crashrank/internal/base/guarded.hpp"
#include "crashrank/internal/report/escape.hpp"
#include "crashrank/report/ranking.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <thread>
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

/// A body other than the ego, with its damage from all contacts of a candidate.
struct HitBody {
  std::size_t actor = 0;  ///< index into Scenario::actors
  double time_s = 0.0;    ///< of its first contact
  Pose pose;              ///< then
  std::vector<std::uint32_t> triangles;
};

void merge(const std::vector<std::uint32_t>& more, std::vector<std::uint32_t>& whole) {
  std::vector<std::uint32_t> both;
  std::set_union(whole.begin(), whole.end(), more.begin(), more.end(), std::back_inserter(both));
  whole = std::move(both);
}

void add_hit(std::size_t actor, double time_s, const BodyDamage& damage,
             std::vector<HitBody>& bodies) {
  auto body = std::find_if(bodies.begin(), bodies.end(),
                           [actor](const HitBody& known) { return known.actor == actor; });
  if (body == bodies.end()) {
    bodies.push_back({actor, time_s, damage.pose, {}});
    body = bodies.end() - 1;
  } else if (time_s < body->time_s) {
    body->time_s = time_s;
    body->pose = damage.pose;
  }
  merge(damage.triangles, body->triangles);
}

/// Every body that is hit, by the ego or by others, in the order of their first contacts.
std::vector<HitBody> hit_bodies(const CandidateResult& ranked) {
  std::vector<HitBody> bodies;
  for (const Contact& contact : ranked.contacts) {
    add_hit(contact.actor, contact.time_of_impact_s, contact.other, bodies);
  }
  for (const FurtherContact& contact : ranked.further) {
    add_hit(contact.a, contact.time_s, contact.damage_a, bodies);
    add_hit(contact.b, contact.time_s, contact.damage_b, bodies);
  }
  std::stable_sort(bodies.begin(), bodies.end(),
                   [](const HitBody& p, const HitBody& q) { return p.time_s < q.time_s; });
  return bodies;
}

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

std::string other_stem(const Picked& picked, std::size_t number, const HitBody& body,
                       const Scenario& scenario) {
  return fmt::format("{}-{}-{}", picked.stem, number + 1,
                     escape_file_name(scenario.actors[body.actor].name));
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
  const std::vector<HitBody> others = hit_bodies(*picked.ranked);
  for (std::size_t i = 0; i < others.size(); ++i) {
    bodies.push_back(other_stem(picked, i, others[i], scenario));
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

Status write_body(const std::string& stem, const TriangleMesh& mesh,
                  const std::vector<std::uint32_t>& damaged) {
  const Result<std::string> glb = damage_glb(mesh, damaged);
  if (!glb) return glb.error();
  if (Status written = write_file(stem + ".glb", glb_file, *glb); !written) return written;
  return write_file(stem + ".ply", ply_file, damage_ply(mesh, damaged));
}

Status write_picture(const std::string& path, View<const PictureBody> bodies) {
  const Result<double> best = azimuth_of_most_damage_deg(bodies);
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
  if (Status written = write_body(ego_stem(picked), ego, ranked.ego.triangles); !written) {
    return written;
  }
  std::vector<PictureBody> bodies{{&ego, ranked.contacts.front().ego.pose, ranked.ego.triangles}};
  const std::vector<HitBody> others = hit_bodies(ranked);
  for (std::size_t i = 0; i < others.size(); ++i) {
    const HitBody& body = others[i];
    const TriangleMesh& mesh = models[scenario.actors[body.actor].model].mesh;
    const std::string stem = other_stem(picked, i, body, scenario);
    if (Status written = write_body(stem, mesh, body.triangles); !written) return written;
    bodies.push_back({&mesh, body.pose, body.triangles});
  }
  Status drawn = write_picture(ego_stem(picked) + ".png", {bodies.data(), 1});
  if (!drawn) return drawn;
  return write_picture(picked.stem + ".png", bodies);
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
  // Files are the same for every number of threads; of errors the first candidate's counts.
  Progress progress("drawing", picked.size());
  std::vector<Status> ends(picked.size(), Success{});
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  const auto work = [&] {
    for (std::size_t i = next++; i < picked.size() && !failed; i = next++) {
      ends[i] = detail::guarded([&] { return write_candidate(picked[i], scenario, models); });
      if (!ends[i]) failed = true;
      progress.advance();
    }
  };
  std::vector<std::thread> threads;
  threads.reserve(options.workers);
  const std::size_t helpers = std::min<std::size_t>(options.workers, picked.size());
  try {
    while (threads.size() + 1 < helpers) threads.emplace_back(work);
  } catch (const std::system_error&) {
    // The system refuses more threads: those that there are do all.
  }
  work();
  for (std::thread& thread : threads) thread.join();
  const auto bad = std::find_if(ends.begin(), ends.end(), [](const Status& end) { return !end; });
  return bad == ends.end() ? Status(Success{}) : *bad;
}

}  // namespace crashrank::cli
