#include "human.hpp"

#include "field.hpp"
#include "surface.hpp"
#include "tidy.hpp"

#include <limits>
#include <map>

namespace generate {
namespace {

struct Piece {
  std::string name;
  Field field;
};

// An ellipsoid that stands along `up` and is widest along `left`.
Field leaning_ellipsoid(const Vec3& center, const Vec3& up, const Vec3& left, const Vec3& radii) {
  const Vec3 z = up.normalized();
  const Vec3 x = left.cross(z).normalized();
  const Vec3 y = z.cross(x);
  return [=](const Vec3& p) {
    const Vec3 q = p - center;
    return ellipsoid(Vec3(q.dot(x), q.dot(y), q.dot(z)), Vec3::Zero(), radii);
  };
}

Field limb(const Vec3& a, const Vec3& b, double ra, double rb) {
  return [=](const Vec3& p) { return round_cone(p, a, b, ra, rb); };
}

std::vector<Piece> pieces_of(const Posture& s) {
  const Vec3 left = s.shoulder[0] - s.shoulder[1];
  const Vec3 spine = s.neck - s.pelvis;
  std::vector<Piece> pieces;
  const Vec3 head_up = s.head - s.neck;
  if (s.helmet) {
    const Field shell = leaning_ellipsoid(s.head, head_up, left, Vec3(0.145, 0.122, 0.135));
    const Vec3 chin = s.head + Vec3(0.085, 0, -0.075);
    pieces.push_back({"helmet", [=](const Vec3& p) {
                        return smooth_min(shell(p), round_cone(p, chin, s.head, 0.060, 0.10), 0.05);
                      }});
    pieces.push_back({"visor", leaning_ellipsoid(s.head + Vec3(0.075, 0, 0.015), Vec3::UnitZ(),
                                                 left, Vec3(0.085, 0.105, 0.052))});
  } else {
    const Field skull =
        leaning_ellipsoid(s.head + 0.02 * Vec3::UnitZ(), head_up, left, Vec3(0.10, 0.078, 0.095));
    const Vec3 chin = s.head + Vec3(0.045, 0, -0.075);
    pieces.push_back({"head", [=](const Vec3& p) {
                        return smooth_min(skull(p), round_cone(p, chin, s.head, 0.042, 0.07), 0.04);
                      }});
  }
  pieces.push_back({"neck", limb(s.neck, s.head, 0.058, 0.052)});
  const Field chest =
      leaning_ellipsoid(s.pelvis + 0.66 * spine, spine, left, Vec3(0.125, 0.172, 0.25));
  const Field waist =
      leaning_ellipsoid(s.pelvis + 0.30 * spine, spine, left, Vec3(0.105, 0.145, 0.20));
  pieces.push_back({"torso", [=](const Vec3& p) {
                      const double trunk = smooth_min(chest(p), waist(p), 0.06);
                      return smooth_min(
                          trunk, round_cone(p, s.shoulder[0], s.shoulder[1], 0.062, 0.062), 0.07);
                    }});
  pieces.push_back({"pelvis", leaning_ellipsoid(s.pelvis + 0.02 * spine, spine, left,
                                                Vec3(0.118, 0.168, 0.135))});
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string side = i == 0 ? "_left" : "_right";
    pieces.push_back({"upper_arm" + side, limb(s.shoulder[i], s.elbow[i], 0.056, 0.043)});
    pieces.push_back({"forearm" + side, limb(s.elbow[i], s.wrist[i], 0.043, 0.030)});
    pieces.push_back({"hand" + side, limb(s.wrist[i], s.fingers[i], 0.035, 0.024)});
    pieces.push_back({"thigh" + side, limb(s.hip[i], s.knee[i], 0.088, 0.058)});
    const Vec3 calf = s.knee[i] + 0.3 * (s.ankle[i] - s.knee[i]) - Vec3(0.018, 0, 0);
    const Field shin = limb(s.knee[i], s.ankle[i], 0.054, 0.038);
    const Field muscle = limb(calf, s.ankle[i], 0.058, 0.034);
    pieces.push_back(
        {"lower_leg" + side, [=](const Vec3& p) { return smooth_min(shin(p), muscle(p), 0.03); }});
    const Vec3 along = (s.toe[i] - s.ankle[i]).normalized();
    const Vec3 heel = s.ankle[i] - 0.035 * along - Vec3(0, 0, 0.045);
    pieces.push_back({"foot" + side, [=](const Vec3& p) {
                        return smooth_min(round_cone(p, heel, s.toe[i], 0.045, 0.034),
                                          round_cone(p, s.ankle[i], s.toe[i], 0.042, 0.028), 0.03);
                      }});
  }
  return pieces;
}

}  // namespace

Model build_person(const Posture& posture, const std::string& prefix, double edge) {
  const std::vector<Piece> pieces = pieces_of(posture);
  const Field body = [&](const Vec3& p) {
    double distance = pieces.front().field(p);
    for (std::size_t i = 1; i < pieces.size(); ++i) {
      distance = smooth_min(distance, pieces[i].field(p), 0.03);
    }
    return distance;
  };
  const Vec3 reach(1.1, 0.9, 1.3);
  Mesh skin = extract_surface(body, posture.pelvis - reach, posture.pelvis + reach, edge);
  const auto corner = [&](const std::array<int, 3>& t, std::size_t k) -> const Vec3& {
    return skin.vertices[static_cast<std::size_t>(t[k])];
  };
  std::vector<int> owner;
  for (const std::array<int, 3>& t : skin.triangles) {
    const Vec3 middle = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0;
    double least = std::numeric_limits<double>::infinity();
    owner.push_back(0);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const double distance = pieces[i].field(middle);
      if (distance >= least) continue;
      least = distance;
      owner.back() = static_cast<int>(i);
    }
  }
  tidy(&skin, &owner, 0.2 * edge);
  std::vector<Mesh> parts(pieces.size());
  std::vector<std::map<int, int>> place(pieces.size());
  for (std::size_t t = 0; t < skin.triangles.size(); ++t) {
    const auto piece = static_cast<std::size_t>(owner[t]);
    std::array<int, 3> renumbered{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [entry, fresh] = place[piece].emplace(
          skin.triangles[t][k], static_cast<int>(parts[piece].vertices.size()));
      if (fresh) parts[piece].vertices.push_back(corner(skin.triangles[t], k));
      renumbered[k] = entry->second;
    }
    parts[piece].triangles.push_back(renumbered);
  }
  Model model;
  for (std::size_t i = 0; i < pieces.size(); ++i) model.add(prefix + pieces[i].name, parts[i]);
  return model;
}

Model build_pedestrian(double edge) {
  Posture s;
  s.pelvis = {0.0, 0.0, 0.95};
  s.neck = {0.03, 0.0, 1.46};
  s.head = {0.055, 0.0, 1.635};
  s.shoulder = {Vec3(0.01, 0.165, 1.405), Vec3(0.03, -0.165, 1.405)};
  s.elbow = {Vec3(-0.13, 0.235, 1.16), Vec3(0.08, -0.24, 1.14)};
  s.wrist = {Vec3(-0.07, 0.255, 0.925), Vec3(0.27, -0.22, 0.99)};
  s.fingers = {Vec3(-0.03, 0.25, 0.83), Vec3(0.36, -0.205, 0.96)};
  s.hip = {Vec3(0.01, 0.09, 0.91), Vec3(-0.01, -0.09, 0.91)};
  s.knee = {Vec3(0.22, 0.095, 0.51), Vec3(0.03, -0.095, 0.49)};
  s.ankle = {Vec3(0.34, 0.095, 0.105), Vec3(-0.30, -0.095, 0.155)};
  s.toe = {Vec3(0.53, 0.115, 0.055), Vec3(-0.16, -0.115, 0.040)};
  return build_person(s, "", edge);
}

Model build_child(double edge) {
  constexpr double scale = 1.14 / 1.75;
  Model model = build_pedestrian(edge / scale);
  for (NamedMesh& part : model.parts) {
    for (Vec3& vertex : part.mesh.vertices) vertex *= scale;
  }
  return model;
}

}  // namespace generate
