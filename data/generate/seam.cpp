#include "seam.hpp"

#include "surface.hpp"
#include "tidy.hpp"

#include <algorithm>
#include <map>

namespace generate {
namespace {

// Carries a vertex to where both the body and the seam are zero.
Vec3 onto_seam(const Field& body, const Field& seam, Vec3 p) {
  for (int round = 0; round < 4; ++round) {
    const Vec3 normal = slope(body, p).normalized();
    Vec3 g = slope(seam, p);
    g -= g.dot(normal) * normal;
    const double size = g.squaredNorm();
    if (size < 0.04) return p;
    p = onto_surface(body, p - seam(p) / size * g, 1);
  }
  return p;
}

// Splits every triangle along its marked edges; `middle` gives the new vertex of an edge.
void split_triangles(Mesh* mesh, const std::map<std::pair<int, int>, int>& middle) {
  const auto find = [&](int a, int b) {
    const auto found = middle.find({std::min(a, b), std::max(a, b)});
    return found == middle.end() ? -1 : found->second;
  };
  const auto length = [&](int a, int b) {
    return (mesh->vertices[static_cast<std::size_t>(a)] -
            mesh->vertices[static_cast<std::size_t>(b)])
        .squaredNorm();
  };
  std::vector<std::array<int, 3>> result;
  result.reserve(mesh->triangles.size() * 2);
  for (const std::array<int, 3>& t : mesh->triangles) {
    std::array<int, 3> m = {find(t[0], t[1]), find(t[1], t[2]), find(t[2], t[0])};
    const int marked = (m[0] >= 0 ? 1 : 0) + (m[1] >= 0 ? 1 : 0) + (m[2] >= 0 ? 1 : 0);
    // Turned so that a single mark is on the first edge and a single gap is on the last one.
    std::size_t turn = 0;
    if (marked == 1) {
      while (m[turn] < 0) ++turn;
    } else if (marked == 2) {
      while (m[(turn + 2) % 3] >= 0) ++turn;
    }
    const int a = t[turn % 3];
    const int b = t[(turn + 1) % 3];
    const int c = t[(turn + 2) % 3];
    const int ab = m[turn % 3];
    const int bc = m[(turn + 1) % 3];
    const int ca = m[(turn + 2) % 3];
    if (marked == 0) {
      result.push_back(t);
    } else if (marked == 1) {
      result.push_back({a, ab, c});
      result.push_back({ab, b, c});
    } else if (marked == 2) {
      result.push_back({ab, b, bc});
      if (length(a, bc) <= length(ab, c)) {
        result.push_back({a, ab, bc});
        result.push_back({a, bc, c});
      } else {
        result.push_back({a, ab, c});
        result.push_back({ab, bc, c});
      }
    } else {
      result.push_back({a, ab, ca});
      result.push_back({ab, b, bc});
      result.push_back({ca, bc, c});
      result.push_back({ab, bc, ca});
    }
  }
  mesh->triangles = std::move(result);
}

// Vertices that triangles use, renumbered in their order.
Mesh compacted(const Mesh& mesh, const std::vector<std::array<int, 3>>& triangles) {
  Mesh result;
  std::vector<int> place(mesh.vertices.size(), -1);
  for (std::array<int, 3> t : triangles) {
    for (int& v : t) {
      int& index = place[static_cast<std::size_t>(v)];
      if (index < 0) {
        index = static_cast<int>(result.vertices.size());
        result.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
      }
      v = index;
    }
    result.triangles.push_back(t);
  }
  return result;
}

}  // namespace

bool Panel::in_reach(const Vec3& p, double margin) const {
  const Vec3 q(p.x(), std::abs(p.y()), p.z());
  return ((q - low).array() > -margin).all() && ((high - q).array() > -margin).all();
}

double Panel::distance(const Vec3& p) const {
  const Vec3 q(p.x(), std::abs(p.y()), p.z());
  double off = 0.0;
  switch (view) {
    case View::side:
      off = outline.distance({q.x(), q.z()});
      break;
    case View::top:
      off = outline.distance({q.x(), q.y()});
      break;
    case View::front:
      off = outline.distance({q.y(), q.z()});
      break;
  }
  return std::max(off, std::max((low - q).maxCoeff(), (q - high).maxCoeff()));
}

void cut(Mesh* mesh, const Field& body, const Field& seam,
         const std::function<bool(const Vec3&)>& reach, double edge, std::vector<bool>* fixed) {
  fixed->resize(mesh->vertices.size(), false);
  std::vector<double> value(mesh->vertices.size(), 1e9);
  std::vector<bool> used(mesh->vertices.size(), false);
  for (std::size_t i = 0; i < mesh->vertices.size(); ++i) {
    Vec3& p = mesh->vertices[i];
    if (!reach(p)) continue;
    used[i] = true;
    value[i] = seam(p);
    if ((*fixed)[i]) {
      // A corner where seams meet: near enough counts as on it.
      if (std::abs(value[i]) < 0.12 * edge) value[i] = 0.0;
      continue;
    }
    if (std::abs(value[i]) > 0.6 * edge) continue;
    const Vec3 target = onto_seam(body, seam, p);
    if ((target - p).squaredNorm() > 0.16 * edge * edge) continue;
    if (std::abs(seam(target)) > 1e-3 * edge) continue;
    p = target;
    value[i] = 0.0;
    (*fixed)[i] = true;
  }
  std::map<std::pair<int, int>, int> middle;
  for (const std::array<int, 3>& t : mesh->triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<std::size_t>(std::min(t[k], t[(k + 1) % 3]));
      const auto b = static_cast<std::size_t>(std::max(t[k], t[(k + 1) % 3]));
      if (!used[a] || !used[b] || value[a] * value[b] >= 0.0) continue;
      const std::pair<int, int> key(static_cast<int>(a), static_cast<int>(b));
      if (middle.count(key) != 0) continue;
      double low = 0.0;
      double high = 1.0;
      const Vec3 from = mesh->vertices[a];
      const Vec3 to = mesh->vertices[b];
      for (int round = 0; round < 30; ++round) {
        const double half = 0.5 * (low + high);
        (seam(from + half * (to - from)) * value[a] > 0.0 ? low : high) = half;
      }
      Vec3 p = from + std::clamp(low, 0.08, 0.92) * (to - from);
      const Vec3 refined = onto_seam(body, seam, p);
      if ((refined - p).squaredNorm() < 0.04 * edge * edge) p = refined;
      middle.emplace(key, static_cast<int>(mesh->vertices.size()));
      mesh->vertices.push_back(p);
      fixed->push_back(true);
    }
  }
  split_triangles(mesh, middle);
}

void add_panels(Model* model, const Field& body, const Mesh& skin, const std::vector<Panel>& panels,
                const std::string& rest, double edge) {
  Mesh mesh = skin;
  std::vector<bool> fixed;
  cut(
      &mesh, body, [](const Vec3& p) { return p.y(); }, [](const Vec3&) { return true; }, edge,
      &fixed);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (fixed[i]) mesh.vertices[i].y() = 0.0;
  }
  std::vector<std::array<int, 3>> left;
  const auto middle_of = [&](const std::array<int, 3>& t) -> Vec3 {
    return (mesh.vertices[static_cast<std::size_t>(t[0])] +
            mesh.vertices[static_cast<std::size_t>(t[1])] +
            mesh.vertices[static_cast<std::size_t>(t[2])]) /
           3.0;
  };
  for (const std::array<int, 3>& t : mesh.triangles) {
    if (middle_of(t).y() > 0.0) left.push_back(t);
  }
  mesh = compacted(mesh, left);
  fixed.assign(mesh.vertices.size(), false);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) fixed[i] = mesh.vertices[i].y() < 1e-9;
  for (const Panel& panel : panels) {
    cut(
        &mesh, body, [&](const Vec3& p) { return panel.distance(p); },
        [&](const Vec3& p) { return panel.in_reach(p, 2.0 * edge); }, edge, &fixed);
  }
  std::vector<int> label;
  for (const std::array<int, 3>& t : mesh.triangles) {
    const Vec3 p = middle_of(t);
    std::size_t k = 0;
    while (k < panels.size() && panels[k].distance(p) >= 0.0) ++k;
    label.push_back(static_cast<int>(k));
  }
  tidy(&mesh, &label, 0.2 * edge);
  std::vector<std::vector<std::array<int, 3>>> groups(panels.size() + 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    groups[static_cast<std::size_t>(label[t])].push_back(mesh.triangles[t]);
  }
  for (std::size_t k = 0; k <= panels.size(); ++k) {
    const std::string& name = k < panels.size() ? panels[k].name : rest;
    if (name.empty()) continue;
    const Mesh part = compacted(mesh, groups[k]);
    if (k < panels.size() && panels[k].paired) {
      model->add_both_sides(name, part);
    } else {
      model->add(name, part);
      model->add(name, mirrored(part));
    }
  }
}

}  // namespace generate
