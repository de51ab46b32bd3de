#pragma once

#include "crash/contact_run.hpp"
#include "crash/tyres.hpp"

#include "crashrank/base/area.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/motion/motion.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// A body of a scene, as it is until something in the chain touches it.
struct SceneBody {
  const Vehicle* vehicle = nullptr;
  const Motion* plan = nullptr;      ///< where it is by time; what nothing moves stays
  const Footing* footing = nullptr;  ///< null: the road does nothing to it
  double steering_rad = 0.0;         ///< of its front wheels once it is hit, left positive
  double brake = 0.02;               ///< share of grip with which it brakes then, [0, 1]
  /// Added to the plan's positions, m.
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
  std::uint32_t number = 0;  ///< by which `adjoins` refers to it
  /// Numbers of the fixed bodies that this fixed body adjoins; symmetric. Those that press on a
  /// body at the same time are one contact, all other fixed bodies are contacts of their own.
  View<const std::uint32_t> adjoins;
};

struct SceneOptions {
  ContactVariant variant;
  ContactOptions contact;
  AfterContact after = AfterContact::brakes;  ///< what the wheels of all that were hit do
  double grip = 0.7;                          ///< of tyres on the road
  View<const Area> drivable;                  ///< empty: the road has no end
  double off_road_grip = 0.7;                 ///< of tyres where the centre of mass is beside it
  double sliding_grip = 0.5;                  ///< of what has no wheels that turn
  double rolling_step_s = 0.02;               ///< longest step without contact
  double after_last_contact_s = 3.0;          ///< the scene ends so long after the last force
  double until_s = 0.0;                       ///< but while anything moves not before this time
  double longest_s = 30.0;                    ///< and so long after its start at the latest
  /// Bodies that are asked about with `would_act` are no faster on their plans.
  double fastest_plan_mps = 0.0;
  bool records_track = false;  ///< needed by `would_act`
};

/// A contact between two bodies of a scene. Its velocities are those of the contact law's end; what
/// follows within `same_contact_s` and changes neither velocity by more than `rubbing_mps`, rubbing
/// on and pushing along, adds to its damage, energy and motion.
struct SceneContact {
  static constexpr double same_contact_s = 0.1;
  static constexpr double rubbing_mps = 0.5;
  /// Forces that follow within this time after the contact law's end, s.
  static constexpr double faded_s = 0.1;

  std::uint32_t a = 0;   ///< index of the body that moves, of two the lower
  std::uint32_t b = 0;   ///< and of the other; of several that adjoin the one pressed most
  double begin_s = 0.0;  ///< on the plans' clock: of its first force
  /// It goes on where the contact law ended an earlier contact of the two, which is validated as
  /// far as that end: no part of that one's event.
  bool goes_on = false;
  /// With the body that the chain's first body meets first. Where other fixed bodies press more,
  /// the contact is theirs.
  bool is_first = false;
  ContactBody given_a;  ///< as it began
  ContactBody given_b;
  ContactOutcome outcome;
  /// Fixed bodies that adjoin each other and pressed on the other body: the first few.
  static constexpr std::size_t most_pressed = 8;
  std::array<std::uint32_t, most_pressed> pressed{};
  std::size_t pressed_count = 0;
};

/// Everything that follows from the chain's first body: it and what it touches, what those touch
/// and so on are rigid bodies in the plane that press on each other and stand on the road; all
/// others keep their plans and pass through each other.
///
/// Momentum is conserved but for the road's forces, energy is never gained. What is crushed stays
/// crushed: a pair of bodies that meets again presses where it has not been. The same bits for the
/// same input; the order of contacts that act on one body at a time changes only rounding, but in
/// the steps in which one of them is stiff enough to take all of the energy along it.
class SceneRun {
public:
  static constexpr std::size_t most_contacts = 64;  ///< told; further ones act untold
  static constexpr std::size_t most_pairs = 64;     ///< of bodies; further ones do not act
  static constexpr std::size_t most_at_once = 40;   ///< contacts; further ones wait
  static constexpr std::size_t most_near = 32;      ///< bodies within a few metres of one

  /// Room for scenes of so many bodies with so many pieces of outline each.
  void prepare(std::size_t bodies, std::size_t pieces);

  /// Begins at a time with the chain's first body and the one that it meets then. Bodies' vehicles,
  /// plans and footings outlive the run. Allocates where more room is needed than was prepared.
  void begin(View<const SceneBody> bodies, std::size_t first, std::size_t partner, double start_s,
             const Eigen::Vector3d& origin_m, const SceneOptions& options);
  /// Takes at most so many steps; false once the scene is over.
  bool advance(int steps);

  /// Contacts with a force that have ended, by the end of their force.
  View<const SceneContact> contacts() const noexcept {
    return {contacts_.data(), contacts_.size()};
  }
  /// Contacts that go on.
  std::size_t at_once() const noexcept { return live_.size(); }
  const ContactRun& live(std::size_t k) const { return runs_[live_[k]]; }
  double now_s() const noexcept { return now_s_; }
  const PlanarBody& body(std::size_t i) const { return memory_.bodies[i].motion; }
  /// Whether something in the chain has touched it.
  bool touched(std::size_t i) const { return members_[i].state >= State::free; }
  /// Pose of its origin now.
  Pose pose(std::size_t i) const { return given(i).pose; }
  /// Whether a body that follows its plan might have come so near the chain as to press or to
  /// shorten a step. One that has not changes no bit of a run: with it, without it or on another
  /// such plan all steps, contacts and outcomes are the same. `most_bodies`: no run that this one
  /// is compared with has more bodies.
  bool would_act(const SceneBody& body, std::size_t most_bodies) const;
  /// Some bodies were too many to be followed: see the limits.
  bool crowded() const noexcept { return crowded_; }
  std::uint64_t steps() const noexcept { return steps_; }
  /// Pieces moved in contacts.
  std::uint64_t work() const noexcept;

private:
  /// A step, as it is when contacts are opened, in its middle.
  struct TrackedStep {
    double time_s = 0.0;
    double step_s = 0.0;
    double before_s = 0.0;    ///< the step before
    std::uint32_t first = 0;  ///< of its bodies in `track_`, in the order of the chain
    std::uint32_t count = 0;
  };
  /// Where a body of the chain is then, and how it moves: to a millimetre is enough.
  struct TrackedBody {
    float x = 0.0F;
    float y = 0.0F;
    float cosine = 1.0F;
    float sine = 0.0F;
    float vx = 0.0F;
    float vy = 0.0F;
    float spin = 0.0F;

    PlanarBody body() const;
  };
  /// Enough for most scenes; after more every body counts as acting.
  static constexpr std::size_t most_tracked = std::size_t{1} << 17U;
  static constexpr std::size_t most_tracked_steps = std::size_t{1} << 14U;
  /// Bodies nearer than this are in each other's lists, m.
  static constexpr double listed_m = 5.0;
  /// Bodies nearer than this may press within the next steps, m.
  static constexpr double live_m = 0.15;

  enum class State : std::uint8_t { fixed, planned, free, rests };
  struct Member {
    State state = State::fixed;
    bool in_chain = false;
    bool pressed = false;       ///< in this step
    std::uint8_t pressing = 0;  ///< contacts that press on it in this step
    Eigen::Vector2d before_mps = Eigen::Vector2d::Zero();  ///< velocity before their forces
    std::uint8_t damaged = 0;                              ///< wheels, see `wheels_after`
    Pose pose;         ///< when it was touched, or where it is fixed
    PlanarBody start;  ///< then
    double rim_m = 0.0;
    double box_x = 0.0;  ///< middle of the outlines' box from the centre of mass, body axes, m
    double box_y = 0.0;
    double half_x = 0.0;
    double half_y = 0.0;
    Wheels wheels;
    double struck_s = -1e9;  ///< when a force last acted that was more than a push
    double placed_s = 0.0;   ///< planned: when it was last placed
    double slack_m = -1.0;   ///< travel until its list of near bodies has to be made anew
    std::size_t near = 0;    ///< bodies in that list
  };

  PlanarBody& motion_of(std::size_t i) { return memory_.bodies[i].motion; }
  bool moves(std::size_t i) const {
    return members_[i].state == State::free || members_[i].state == State::planned;
  }
  ContactBody given(std::size_t i) const;
  void place(std::size_t i);
  void join_chain(std::size_t i);
  void touch(std::size_t i);
  void set_wheels(std::size_t i);
  double least_gap_m(std::size_t i, std::size_t j) const;
  double gap_m(std::size_t i, std::size_t j) const;
  static double gap_m(const Member& m, const PlanarBody& p, const Member& n, const PlanarBody& q);
  static double corner_distance2(const Member& box, const Member& of, double x, double y,
                                 double cosine, double sine);
  static void measure(const Vehicle& vehicle, Member& member);
  double closing_bound(std::size_t i, std::size_t j) const;
  bool lists(std::size_t i, std::size_t j) const;
  void track(double step_s);
  bool comes_near(const SceneBody& body, const Member& member, std::size_t place,
                  double more_m) const;
  void list_near();
  void list_near(std::size_t i);
  template <typename Each> void each_near_pair(Each each);
  double next_step_s();
  void open_contacts();
  void open(std::size_t i, std::size_t j);
  ContactRun* live_with(std::size_t i, std::size_t j);
  bool adjoins_any(std::size_t i, const ContactRun& run) const;
  std::uint32_t pair_of(std::size_t i, std::size_t j, bool& in_memory);
  void close(ContactRun& run);
  void tell(const ContactRun& run, const ContactOutcome& outcome, bool swapped);
  void tell_pressed(const ContactRun& run, SceneContact& told) const;
  void lock_damaged_wheels(std::size_t i, const Box& damaged);
  void press();
  double grip_of(std::size_t i) const;
  void drive_on_road(std::size_t i, double step_s);
  void settle();
  void step();

  View<const SceneBody> bodies_;
  SceneOptions options_;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();
  ContactWorkspace::State memory_;
  std::vector<Member> members_;
  std::vector<std::uint32_t> chain_;
  std::vector<std::uint32_t> near_;  ///< `most_near` for each body
  std::vector<ContactRun> runs_;
  std::vector<double> begun_s_;       ///< by run
  std::vector<char> goes_on_;         ///< by run, see SceneContact
  std::vector<std::uint32_t> live_;   ///< runs that go on
  std::vector<std::uint32_t> spare_;  ///< runs that do not
  std::vector<SceneContact> contacts_;
  std::vector<TrackedStep> track_steps_;
  std::vector<TrackedBody> track_;
  bool track_ends_ = false;                ///< there was more than room
  double track_step_s_ = 0.0;              ///< the last one's
  double track_fastest_mps_ = 0.0;         ///< of any point of the chain
  const ContactRun* first_run_ = nullptr;  ///< with the first body's partner
  std::size_t partner_ = 0;
  double start_s_ = 0.0;
  double now_s_ = 0.0;
  double placed_s_ = 0.0;  ///< middle of the last step, for which near bodies were placed
  double last_force_s_ = 0.0;
  double fastest_plan_mps_ = 0.0;  ///< of any point of a planned body
  double fastest_mps_ = 0.0;       ///< and of those that were touched
  bool over_ = true;
  bool crowded_ = false;
  std::uint64_t steps_ = 0;
  std::uint64_t ended_work_ = 0;
};

}  // namespace crashrank::detail
