#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace crashrank {

// A ranking as JSON, text and a page. All take the arguments and the result of `rank`.

/// One JSON document, keys in a fixed order, numbers in the shortest form that reads back to the
/// same bits; what is infinite or not known is null. Every candidate is listed, best first. In a
/// candidate's entry `other` and the time and speed beside it are those of its first contact, the
/// damage of `ego` and `other` that of all its contacts together, `other` being all other bodies.
/// `contacts` lists the ego's and those between others by their begins, each with its own damage.
/// Units stand in the keys; angles are degrees. `warnings` are those given, such as the importer's,
/// then `ranking_doubts`.
CRASHRANK_API std::string ranking_json(const Scenario& scenario, View<const Model> models,
                                       const RankResult& result,
                                       View<const std::string> warnings = {});

/// What the table shows.
struct RankingTextOptions {
  std::size_t top = 0;    ///< most candidates shown, 0 for all
  bool colours = false;   ///< ANSI codes for the titles
  std::size_t width = 0;  ///< most characters of a line, from 80; 0: any number
};

/// A table, best candidate first, and lines about what is not in it, such as
/// contacts between others that injure people. Names are escaped for a
/// terminal.
CRASHRANK_API std::string ranking_text(const Scenario& scenario, View<const Model> models,
                                       const RankResult& result,
                                       const RankingTextOptions& options = {});

/// Reasons to doubt places of a valid answer, one sentence each, names not escaped: contacts faster
/// than the crash model reaches, more contacts than are simulated, bodies that overlap at the
/// start, listed manoeuvres beyond the grip of the tyres, timed poses that end while their body
/// moves or begin at another speed than the ego's, bodies known by their boxes alone, meshes that
/// seem turned or have a size or mass that no body of their kind has, bodies that float, keys of
/// the scenario that are without effect. At most the squared number of bodies.
CRASHRANK_API std::vector<std::string> ranking_doubts(const Scenario& scenario,
                                                      View<const Model> models,
                                                      const RankResult& result);

/// Why an answer is partial and whether its first place is proved, as a warning; `bounded`: it was
/// ranked within a budget.
CRASHRANK_API std::string why_partial(const RankResult& result, bool bounded);

/// Progress of an interrupted ranking, as a warning: the number of candidates with a score.
CRASHRANK_API std::string ranking_progress(const RankResult& result);

/// An SVG picture of a scenario from above at time 0, with all bodies, the ways of the actors (in
/// all their predictions) until the horizon, and the road. A model for each of the scenario's, as
/// for `rank`.
CRASHRANK_API std::string scenario_plan(const Scenario& scenario, View<const Model> models);

/// Most candidates whose motion the program and the Python package record for the page: up to a
/// megabyte each.
inline constexpr std::size_t most_played_candidates = 1000;

/// What the page shows.
struct HtmlReportOptions {
  /// Candidates that are played and described, best first, and the worst one; 0 for all. Every
  /// candidate is in the table.
  std::size_t drawn = 24;
  /// Meshes of more triangles than this are drawn with fewer; the report says so. At most 7,000.
  std::size_t model_triangles = 7'000;
  /// Holds a still picture of the first one, for browsers without WebGL, some 150 kB.
  bool still = true;
  /// The page's version on the server that it is to come from, 0 without a server: the page asks
  /// that server for /version?after=VERSION, and reloads itself when the answer is another one.
  std::uint64_t served_version = 0;
  /// A line above the report, such as an error of a newer scenario; empty: none.
  std::string notice;
};

/// One page for people, from what `rank` was given and what it answered: the decision in a
/// sentence, who may be hurt, the scene as it moves in plan and in 3-D with the damage in red, the
/// ranked table, what is not known, and for each drawn candidate its contacts and damage by part.
/// Without CandidateResult::motion (RankOptions::records_motion) the pictures end at first
/// contacts. The page is a single file that asks nothing of the network. Names come from files that
/// are not trusted and are escaped. The same ranking gives the same bytes, but for the time that it
/// took. Cost: about 15 bytes a triangle of each model shown, some 30 kB a drawn candidate and 150
/// bytes a row.
CRASHRANK_API std::string html_report(const Scenario& scenario, View<const Model> models,
                                      const RankResult& result,
                                      const HtmlReportOptions& options = {});

/// The motion of the candidate in a row of the ranking (0: the winner) as glTF 2.0 binary, for
/// Blender and other viewers: what the page plays of it, in its likeliest future, in metres and
/// seconds from the decision. Every body is a node of its name with the whole mesh of its model,
/// which bodies share, under one root node that turns the world (z up) into glTF's axes (y up).
/// Nodes that move have linear key frames of translation and rotation in one animation of the
/// candidate's name, within 0.5 mm and 0.5 mrad of the samples. Damage is not shown. Without
/// CandidateResult::motion a crash ends at its first contact. Errors: usage for a row that the
/// ranking lacks; limit_exceeded above 4 GiB. Cost: linear in the meshes and the motion.
CRASHRANK_API Result<std::string> ranking_animation(const Scenario& scenario,
                                                    View<const Model> models,
                                                    const RankResult& result,
                                                    std::size_t place = 0);

// Pictures and models of damaged bodies.

/// Rows from the top, pixels from the left, three bytes sRGB each.
struct Image {
  int width = 0;                  ///< pixels
  int height = 0;                 ///< pixels
  std::vector<std::uint8_t> rgb;  ///< three bytes a pixel, rows from the top
};

/// A body in a picture.
struct PictureBody {
  const TriangleMesh* mesh = nullptr;  ///< not null
  Pose pose;                           ///< body to world
  View<const std::uint32_t> damaged;   ///< triangles drawn in the colour of damage
};

/// How large a picture is, and from where.
struct PictureOptions {
  int width_px = 1200;  ///< pixels
  int height_px = 750;  ///< pixels
  /// Where the camera stands, seen from the middle of the scene, in world axes: degrees
  /// counter-clockwise from +x, and degrees above the ground.
  double azimuth_deg = 40.0;
  double elevation_deg = 22.0;      ///< of the camera above the ground
  double field_of_view_deg = 28.0;  ///< across the picture's width
  bool edges = true;                ///< draw the triangles' edges where they are large enough
};

/// Draws the bodies in perspective on a light ground, shaded, with damaged triangles in red: the
/// still picture that figure 1 of Wiseman & Grinberg 2016 is. Parts whose names speak of glass,
/// tyres or lamps get colours of such; the first body's paint is blue, the others' sand. The same
/// input draws the same picture on one machine; colours may differ by a step between machines.
/// Cost: half a second for 1200 x 750 and 100,000 triangles; memory about 100 bytes a pixel.
/// Errors: usage for no triangle, a width or height outside 16 to 4096, angles that are not finite,
/// a field of view outside 1 to 120 or an elevation outside -89 to 89 degrees.
CRASHRANK_API Result<Image> draw_picture(View<const PictureBody> bodies,
                                         const PictureOptions& options = {});

/// What a sheet of three views shows.
struct ThreeViewOptions {
  int width_px = 1200;                  ///< pixels
  int height_px = 900;                  ///< pixels
  std::optional<double> rear_axle_x_m;  ///< marked where it is known
  bool marks = true;    ///< axes, ground, axle, sizes and words; else the body alone
  std::string caption;  ///< below the size; of small letters but j and q, digits and "+-=.,:"
};

/// Draws a mesh in body axes from above, from its right and from its front, parallel and to one
/// scale, each part in a colour of its own. Marks: the axes (x red, y green, z blue) at the origin
/// and the ground, z = 0, where they are at most half the body's longest side away from it, the
/// rear axle, the size and a length scale. Triangles with coordinates that are not finite are left
/// out. Cost: as `draw_picture`. Errors: usage for no triangle, or a width or height outside 400 to
/// 4096.
CRASHRANK_API Result<Image> draw_three_views(const TriangleMesh& mesh,
                                             const ThreeViewOptions& options = {});

/// Where a body's damage lies: the mean direction of its damaged triangles, seen from the body's
/// middle, as an azimuth in world axes; 0 without damage. A camera 30 to 60 degrees beside it
/// shows the damage and the body's length.
CRASHRANK_API double azimuth_of_damage_deg(const PictureBody& body);

/// Of eight places around the scene the azimuth, degrees, from which most of the picture is damage;
/// those beside `azimuth_of_damage_deg` of the first body unless another shows a tenth more. Cost:
/// some milliseconds for 100,000 triangles. Errors: usage for no triangle.
CRASHRANK_API Result<double> azimuth_of_most_damage_deg(View<const PictureBody> bodies);

/// The image as a PNG file's bytes. Errors: internal when libpng fails.
CRASHRANK_API Result<std::string> png(const Image& image);

// A body with its damaged triangles highlighted, as in figure 1 of Wiseman & Grinberg 2016, in
// formats that every mesh viewer reads. Both return the file's bytes; `damaged` holds indices of
// triangles, each at most once, in any order, all within the mesh. Linear in the mesh; safe from
// any thread.

/// glTF 2.0 binary. Each part is a node of its name; its intact and its damaged triangles have a
/// material each, named "intact" and "damaged". Coordinates stay in body axes under one root node
/// that turns them into glTF's (y up, z forward). Errors: limit_exceeded above 4 GiB.
CRASHRANK_API Result<std::string> damage_glb(const TriangleMesh& mesh,
                                             View<const std::uint32_t> damaged);

/// Binary PLY with coloured vertices, in body coordinates, triangles in the mesh's order. Vertices
/// that both intact and damaged triangles use stand in it twice, once in each colour.
CRASHRANK_API std::string damage_ply(const TriangleMesh& mesh, View<const std::uint32_t> damaged);

}  // namespace crashrank
