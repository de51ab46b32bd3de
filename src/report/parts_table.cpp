#include "report/parts_table.hpp"

#include "crashrank/internal/report/escape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace crashrank::detail {
namespace {

struct PartDamage {
  std::string name;
  std::size_t triangles = 0;
  double area_m2 = 0.0;
  double whole_m2 = 0.0;
};

double triangle_area_m2(const TriangleMesh& mesh, std::size_t index) {
  const Triangle t = mesh.triangle(index);
  const Eigen::Vector3d a = t.corner[0].cast<double>();
  return 0.5 * (t.corner[1].cast<double>() - a).cross(t.corner[2].cast<double>() - a).norm();
}

std::vector<PartDamage> damage_by_part(const TriangleMesh& mesh, const BodyDamage& damage) {
  std::vector<PartDamage> parts;
  for (const std::uint32_t index : damage.parts) {
    const Part& part = mesh.parts[index];
    PartDamage row{part.name};
    const std::uint32_t end = part.first_triangle + part.triangle_count;
    for (std::uint32_t i = part.first_triangle; i < end; ++i) {
      row.whole_m2 += triangle_area_m2(mesh, i);
    }
    const auto first =
        std::lower_bound(damage.triangles.begin(), damage.triangles.end(), part.first_triangle);
    const auto last = std::lower_bound(first, damage.triangles.end(), end);
    row.triangles = static_cast<std::size_t>(last - first);
    for (auto i = first; i != last; ++i) row.area_m2 += triangle_area_m2(mesh, *i);
    parts.push_back(std::move(row));
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const PartDamage& p, const PartDamage& q) { return p.area_m2 > q.area_m2; });
  return parts;
}

/// "front_bumper" as people write it.
std::string spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace

std::string parts_table(const std::string& title, const TriangleMesh& mesh,
                        const BodyDamage& damage) {
  constexpr std::size_t shown = 8;
  std::string html = "<table class='parts'><caption>" + escape_xml(title) +
                     "</caption><thead><tr><th>part</th><th>damaged m²</th><th>of the part</th>"
                     "</tr></thead><tbody>\n";
  const std::vector<PartDamage> parts = damage_by_part(mesh, damage);
  for (std::size_t i = 0; i < std::min(shown, parts.size()); ++i) {
    const PartDamage& part = parts[i];
    const double share = part.whole_m2 > 0.0 ? 100.0 * part.area_m2 / part.whole_m2 : 0.0;
    html +=
        fmt::format("<tr><td>{}</td><td class='n'>{:.3f}</td><td class='n'>{:.0f} %</td></tr>\n",
                    escape_xml(spaced(part.name)), part.area_m2, share);
  }
  html += "</tbody></table>\n";
  if (parts.size() > shown) {
    html += fmt::format("<p class='more'>and {} more parts</p>\n", parts.size() - shown);
  }
  return html;
}

}  // namespace crashrank::detail
