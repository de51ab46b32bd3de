#pragma once

#include <string>

namespace crashrank::cli {

// Charts as SVG. Titles may be any text and are escaped; places and lengths on the picture are px.

/// The range of an axis, and the distance of its ticks, which lie at multiples of it.
struct ChartAxis {
  double lowest = 0.0;
  double highest = 1.0;
  double step = 1.0;
};

/// An axis from tick to tick around two finite values, in eight to ten steps at most, each 1, 2 or
/// 5 times a power of ten.
ChartAxis chart_axis(double least, double most);

/// How a line is drawn.
struct ChartStroke {
  const char* colour = "#000000";
  const char* dash = "";  ///< as SVG's stroke-dasharray; empty: drawn through
};

/// A pair of axes. Beside the frame numbers and title of y need 64 px on the left, the panel's
/// title 20 px above, numbers and title of x 40 px below.
struct ChartPanel {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;
  ChartAxis x;
  ChartAxis y;

  double x_px(double value) const;
  double y_px(double value) const;
  /// The frame with ticks and titles; an empty title is left out.
  std::string frame(const std::string& title, const std::string& x_title,
                    const std::string& y_title) const;
  /// A straight line between two points of the axes.
  std::string line(double x0, double y0, double x1, double y1, const ChartStroke& stroke) const;
};

/// A sample of a line and what it stands for.
std::string chart_key(double x, double y, const ChartStroke& stroke, const std::string& what);

/// The whole picture. Title and subtitle take its first 50 px.
std::string chart_picture(double width, double height, const std::string& title,
                          const std::string& subtitle, const std::string& content);

}  // namespace crashrank::cli
