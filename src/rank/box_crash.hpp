#pragma once

#include "crash/exposure.hpp"
#include "crash/planar_body.hpp"
#include "crash/tyres.hpp"
#include "rank/crash_score.hpp"
#include "rank/scene.hpp"
#include "rank/stop_check.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace crashrank::detail {

/// A crash and what follows from it, coarsely: bodies are the boxes around their outlines. Where
/// two boxes overlap, the structure of both is crushed in series, along the gradient of the
/// overlap's area and over as much width as that gradient has. It takes some ten microseconds and
/// needs no search for contacts. Its scores bound nothing: they order candidates whose crashes are
/// not simulated.
class BoxCrash {
public:
  /// Allocates for scenes with up to `bodies` bodies.
  void prepare(std::size_t bodies);

  /// Estimate of the score of the ego on its motion in a future, without what leaving the road
  /// adds; nothing if it was stopped. Depends on the scene and the motion alone. `effects` and
  /// `scorer` are working memory.
  std::optional<double> score(const Scene& scene, const Motion& ego, std::size_t future,
                              const StopCheck& stop, CrashEffects& effects, CrashScore& scorer);
  /// Tests of pairs of boxes in the last crash: the work done.
  std::uint64_t tests() const noexcept { return tests_; }

private:
  enum class State : std::uint8_t { fixed, planned, free };
  struct Box {
    State state = State::fixed;
    bool in_chain = false;
    bool pressed = false;  ///< in this step
    std::size_t index = ego_body;
    const Body* body = nullptr;
    const Motion* plan = nullptr;
    double rest_s = 0.0;  ///< time from which it rests on its plan
    double half_x = 0.0;  ///< half the size of the box, m
    double half_y = 0.0;
    double box_x = 0.0;  ///< its centre relative to the centre of mass, body axes, m
    double box_y = 0.0;
    double radius_m = 0.0;     ///< of the circle about the centre of mass that holds the box
    double changed_mps = 0.0;  ///< sum of the changes of velocity by contacts
    double deepest_m = 0.0;    ///< crush behind the free crush length
    PlanarBody motion;
    Wheels wheels;
    ExposureCell action;  ///< of the step
  };
  struct Pair {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    ContactEffect effect;
  };
  /// What two boxes do to each other in a step.
  struct Push;

  void begin(const Scene& scene, const Motion& ego, std::size_t future);
  void place(Box& box) const;
  double list_overlaps();
  void press(const Scene& scene, std::uint32_t i, std::uint32_t j, double step_s);
  void act(const Scene& scene, std::uint32_t i, const Body& by, const Push& push, bool first);
  void leave_plan(const Scene& scene, std::uint32_t i);
  void move(const Scene& scene, double step_s);
  void record(std::uint32_t i);
  ContactEffect* effect_of(std::uint32_t i, std::uint32_t j, double speed_mps);

  double now_s_ = 0.0;
  double begin_s_ = 0.0;  ///< time of the first force; negative before it
  double end_s_ = 0.0;
  std::uint64_t tests_ = 0;
  std::vector<Box> boxes_;            ///< the ego first
  std::vector<std::uint32_t> chain_;  ///< bodies that a force acted on, and the ego
  std::vector<std::array<std::uint32_t, 2>> overlaps_;
  std::vector<double> wake_s_;                    ///< by two boxes: they do not meet before
  std::vector<Pair> pairs_;                       ///< that have pressed on each other
  std::vector<std::vector<ExposureCell>> cells_;  ///< by box
};

}  // namespace crashrank::detail
