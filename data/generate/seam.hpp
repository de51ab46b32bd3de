#pragma once

#include "curve.hpp"
#include "field.hpp"
#include "mesh.hpp"

#include <string>
#include <vector>

namespace generate {

/// Which way an outline is laid on a body: its plane coordinates are (x, z) from the side, (x, |y|)
/// from above, (|y|, z) from the front or back. Both sides of the body are cut alike.
enum class View { side, top, front };

/// A panel of a body: the skin inside `outline`, looked at from `view`, within the box low..high
/// (in x, |y|, z). Panels are tried in order and the first that holds a place has it.
struct Panel {
  std::string name;  ///< empty: the skin is taken away (an opening)
  View view;
  Outline outline;
  Vec3 low;
  Vec3 high;
  bool paired = false;  ///< two panels, NAME_left and NAME_right

  /// Whether the box grown by `margin` holds the place.
  bool in_reach(const Vec3& p, double margin) const;
  /// Distance to the panel's limits, m, negative inside.
  double distance(const Vec3& p) const;
};

/// Moves vertices of `mesh` that lie near a zero of `seam` onto it and splits the edges that still
/// cross it, so that no triangle lies on both sides; `reach` says where the seam runs. Vertices
/// moved or made are marked in `fixed` and stay where they are in later cuts.
void cut(Mesh* mesh, const Field& body, const Field& seam,
         const std::function<bool(const Vec3&)>& reach, double edge, std::vector<bool>* fixed);

/// Cuts the skin of `body` into panels and adds them to the model; what no panel holds gets the
/// name `rest`. The body must be symmetric about y = 0: its left half is cut and mirrored.
void add_panels(Model* model, const Field& body, const Mesh& skin, const std::vector<Panel>& panels,
                const std::string& rest, double edge);

}  // namespace generate
