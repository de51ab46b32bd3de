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
#include <limits>
#include <vector>

namespace crashrank::detail {

/// A body of a scene before its first contact.
struct SceneBody {
  const Vehicle* vehicle = nullptr;
  const Motion* plan = nullptr;      ///< pose over time; a fixed body stays at its start pose
  const Footing* footing = nullptr;  ///< null: no road forces
  double steering_rad = 0.0;         ///< front wheels after its first contact, left positive
  double brake = 0.02;  ///< share of grip used for braking after its first contact, [0, 1]
  /// Offset added to the plan's positions, m.
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
  std::uint32_t number = 0;  ///< number by which `adjoins` refers to the body
  /// Numbers of the fixed bodies that this fixed body adjoins; symmetric. Adjoining fixed bodies
  /// that press on a body at the same time form one contact; other fixed bodies have contacts of
  /// their own.
  View<const std::uint32_t> adjoins;
};

/// Options of a scene.
struct SceneOptions {
  ContactVariant variant;
  ContactOptions contact;
  AfterContact after = AfterContact::brakes;  ///< wheels of all bodies after their first contact
  double grip = 0.7;                          ///< friction of tyres on the road
  View<const Area> drivable;                  ///< drivable areas; empty: everywhere
  double off_road_grip = 0.7;  ///< friction of tyres while the centre of mass is off the road
  double sliding_grip = 0.5;   ///< upper bound of the friction of bodies without turning wheels
  /// Drivers follow their plans less and less until contacts have changed their velocity by this
  /// sum, m/s; 0: not after the first force.
  double plan_ends_mps = 1.0;
  double rolling_step_s = 0.02;       ///< longest step without contact
  double after_last_contact_s = 3.0;  ///< the scene ends this long after the last force
  double until_s = 0.0;               ///< but not before this time while a body moves
  double longest_s = 30.0;            ///< and at the latest this long after its start
  /// Upper bound of the speed that bodies passed to `would_act` have on their plans, m/s.
  double fastest_plan_mps = 0.0;
  bool records_track = false;  ///< records the track that `would_act` needs
};

/// A contact between two bodies of a scene. Its velocities are those at the end of the contact law.
/// Later forces between the same bodies are merged into it if they begin within `merge_window_s`:
/// the bodies scrape along or push each other. No score depends on that.
struct SceneContact {
  static constexpr double merge_window_s = 0.1;

  std::uint32_t a = 0;  ///< index of the movable body; of two movable bodies the lower index
  /// Index of the other body; of several adjoining fixed bodies the one with the largest impulse.
  std::uint32_t b = 0;
  double begin_s = 0.0;  ///< on the plans' clock: of its first force, of the scene's first contact
                         ///< that of the touch
  double first_force_s = 0.0;  ///< time of its first force on that clock
  /// Contact with the partner: the body that the chain's first body contacts first. If the partner
  /// is fixed and another fixed body of the contact receives more impulse, the contact is reported
  /// for that body and this is false.
  bool is_first = false;
  ContactBody given_a;  ///< state at the beginning of the contact
  ContactBody given_b;
  ContactOutcome outcome;
  /// Adjoining fixed bodies that pressed on the other body, up to `most_pressed`.
  static constexpr std::size_t most_pressed = 8;
  std::array<std::uint32_t, most_pressed> pressed{};
  std::size_t pressed_count = 0;
};

/// Simulates a crash with all its consequences. The chain consists of its first body, the bodies
/// that it contacts, those that they contact and so on. Bodies of the chain are rigid bodies in the
/// plane, subject to contact forces and the forces of the road; all others follow their plans and
/// pass through each other.
///
/// Momentum is conserved except for the forces of the road, and energy never grows. Crushed
/// structure stays crushed: a pair of bodies in a further contact presses only where it has not
/// crushed yet. Equal input gives equal bits. The order of contacts that act on one body at the
/// same time changes only rounding, except in steps in which one of them is stiff enough to take
/// all energy along its direction.
class SceneRun {
public:
  static constexpr std::size_t most_contacts = 64;  ///< recorded; further ones are not recorded
  static constexpr std::size_t most_pairs = 64;     ///< pairs in contact; further ones do not act
  static constexpr std::size_t most_at_once = 40;   ///< open contacts; further ones open later
  /// Blocks of outlines that come near other bodies; further ones do not press. Twice what random
  /// pile-ups with 36 pairs in contact take.
  static constexpr std::size_t most_near_blocks = std::size_t{3} << 11U;
  static constexpr std::size_t most_near = 32;  ///< near bodies listed for each body
  static constexpr double on_plan_m = 0.1;
  static constexpr std::size_t most_recorded =
      most_pairs + 1;  ///< bodies whose exposure is recorded

  /// Allocates room for scenes with up to `bodies` bodies of up to `pieces` outline pieces each,
  /// and for tracks if they are recorded.
  void prepare(std::size_t bodies, std::size_t pieces, bool tracks);

  /// Starts the simulation at `start_s` with the chain's first body and the partner that it
  /// contacts at that time. Vehicles, plans and footings have to outlive the run. Allocates where
  /// `prepare` did not provide enough room.
  void begin(View<const SceneBody> bodies, std::size_t first, std::size_t partner, double start_s,
             const Eigen::Vector3d& origin_m, const SceneOptions& options);
  /// Takes up to `steps` steps; returns false once the scene is over.
  bool advance(int steps);
  bool over() const noexcept { return over_; }

  /// Contacts with a force that have ended, in the order of their ends.
  View<const SceneContact> contacts() const noexcept {
    return {contacts_.data(), contacts_.size()};
  }
  /// What contact forces did to a body so far. Only the cells before `current_cell` are complete.
  View<const ExposureCell> exposure_cells(std::size_t i) const {
    const std::size_t record = members_[i].record;
    return record == no_record ? View<const ExposureCell>{} : records_[record].cells();
  }
  std::int32_t current_cell() const noexcept;
  /// Number of contacts in progress.
  std::size_t at_once() const noexcept { return active_.size(); }
  const ContactRun& live(std::size_t k) const { return runs_[active_[k]]; }
  double now_s() const noexcept { return now_s_; }
  const PlanarBody& body(std::size_t i) const { return memory_.bodies[i].motion; }
  /// Returns true if a contact force acted on it in the last step.
  bool pressed(std::size_t i) const { return members_[i].action.path_mps > 0.0; }
  /// Returns true if a body of the chain has contacted it.
  bool touched(std::size_t i) const { return members_[i].state >= State::free; }
  /// Time until which no point of the body was further than `on_plan_m` from its plan, s; infinity:
  /// it still keeps to it.
  double on_plan_until_s(std::size_t i) const { return members_[i].on_plan_until_s; }
  /// Present pose of the body origin.
  Pose pose(std::size_t i) const { return contact_body(i).pose; }
  /// Returns true if a body on its plan might have come close enough to the chain to press on it or
  /// to shorten a step. If false, the body does not influence the run: without it, or with another
  /// plan for which the result is false, all steps, contacts and outcomes have the same bits.
  /// `most_bodies`: largest number of bodies in the runs that are compared.
  bool would_act(const SceneBody& body, std::size_t most_bodies) const;
  /// Returns true if a limit (see the constants above) was exceeded, so that some contacts were
  /// left out.
  bool crowded() const noexcept { return limit_exceeded_ || memory_.pool.exceeded; }
  std::uint64_t steps() const noexcept { return steps_; }
  /// Number of outline pieces moved in contacts: the amount of work done.
  std::uint64_t work() const noexcept;

private:
  /// A step as recorded in its middle, when contacts are opened.
  struct TrackedStep {
    double time_s = 0.0;
    double step_s = 0.0;
    double before_s = 0.0;    ///< length of the previous step
    std::uint32_t first = 0;  ///< index of its first body in `track_`, in the order of the chain
    std::uint32_t count = 0;
  };
  /// State of a body of the chain at that time. Single precision resolves the position to better
  /// than 1 mm.
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
  /// Size of the track. It suffices for most scenes; once it is full, `would_act` returns true for
  /// every body.
  static constexpr std::size_t most_tracked = std::size_t{1} << 17U;
  static constexpr std::size_t most_tracked_steps = std::size_t{1} << 14U;
  /// Bodies nearer than this are in the lists of near bodies, m.
  static constexpr double listed_m = 5.0;
  /// Bodies nearer than this have an open contact, because they may press within the next steps, m.
  static constexpr double live_m = 0.15;

  static constexpr auto no_record = static_cast<std::size_t>(-1);

  /// fixed: not movable, or a post that has not broken away; planned: follows its plan; free: moved
  /// by forces; rests: free and at rest.
  enum class State : std::uint8_t { fixed, planned, free, rests };
  struct Member {
    State state = State::fixed;
    bool in_chain = false;
    bool pressed = false;            ///< a contact force acted in this step
    std::size_t record = no_record;  ///< index in `records_`
    ExposureCell state_before;       ///< before the contact forces of this step
    ContactAction action;            ///< of all contacts in this step
    double deepest_m = 0.0;          ///< deepest intrusion so far
    double changed_mps = 0.0;        ///< sum of the changes of velocity by contacts so far
    std::uint8_t damaged = 0;        ///< damaged wheels, see `wheels_after`
    Pose pose;                       ///< pose at its first contact, or where it was fixed
    PlanarBody start;                ///< planar state at that time
    double radius_m = 0.0;           ///< of the bounding circle about the centre of mass
    /// Centre of the outlines' bounding box relative to the centre of mass, body axes, m.
    double box_x = 0.0;
    double box_y = 0.0;
    double half_x = 0.0;  ///< half the size of that box, m
    double half_y = 0.0;
    Wheels wheels;
    double last_impact_s = -1e9;  ///< time of the last force larger than a push
    double placed_s = 0.0;        ///< planned body: time of its last placement
    double on_plan_until_s = std::numeric_limits<double>::infinity();
    double slack_m = -1.0;  ///< relative travel until a new list of near bodies is needed
    std::size_t near = 0;   ///< number of bodies in that list
  };

  PlanarBody& motion_of(std::size_t i) { return memory_.bodies[i].motion; }
  bool moves(std::size_t i) const {
    return members_[i].state == State::free || members_[i].state == State::planned;
  }
  ContactBody contact_body(std::size_t i) const;
  void place_planned(std::size_t i);
  void join_chain(std::size_t i);
  void mark_touched(std::size_t i);
  void break_away();
  void set_wheels(std::size_t i);
  double gap_lower_bound_m(std::size_t i, std::size_t j) const;
  double gap_m(std::size_t i, std::size_t j) const;
  static double gap_m(const Member& m, const PlanarBody& p, const Member& n, const PlanarBody& q);
  static double corner_distance2(const Member& box, const Member& of, double x, double y,
                                 double cosine, double sine);
  static void compute_extents(const Vehicle& vehicle, Member& member);
  double closing_bound(std::size_t i, std::size_t j) const;
  bool heights_apart(std::size_t i, std::size_t j, const PlanarBody& at) const;
  bool has_listed(std::size_t i, std::size_t j) const;
  void track(double step_s);
  bool comes_near(const SceneBody& body, const Member& member, std::size_t place,
                  double more_m) const;
  void list_near();
  void list_near(std::size_t i);
  template <typename Function> void for_each_near_pair(Function function);
  double next_step_s();
  void open_contacts();
  void open_contact(std::size_t i, std::size_t j);
  ContactRun* live_with(std::size_t i, std::size_t j);
  bool adjoins_any(std::size_t i, const ContactRun& run) const;
  std::uint32_t pair_of(std::size_t i, std::size_t j, bool& seen_before);
  void close_contact(ContactRun& run);
  void record_contact(const ContactRun& run, const ContactOutcome& outcome, bool swapped);
  void record_pressed(const ContactRun& run, SceneContact& contact) const;
  void lock_damaged_wheels(std::size_t i, const Box& damaged);
  void apply_contact_forces(double step_s);
  void record_actions(double step_s);
  double grip_of(std::size_t i) const;
  double plan_share(double changed_mps) const;
  PlanarBody planned_body(std::size_t i, double time_s) const;
  void follow_plan(std::size_t i, double share, double step_s);
  void compare_with_plans();
  void apply_road_forces(std::size_t i, double step_s);
  void stop_resting_bodies();
  void step();

  View<const SceneBody> bodies_;
  SceneOptions options_;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();
  ContactWorkspace::State memory_;
  std::vector<Member> members_;
  std::vector<std::uint32_t> chain_;
  std::vector<std::uint32_t> posts_;  ///< bodies that may break away
  std::vector<std::uint32_t> near_;   ///< `most_near` entries for each body
  std::vector<ContactRun> runs_;
  std::vector<double> begun_s_;           ///< by run: time of its beginning
  std::vector<double> forced_s_;          ///< by run: time of its first force
  std::vector<std::uint32_t> active_;     ///< runs in progress
  std::vector<std::uint32_t> free_runs_;  ///< unused runs
  std::vector<SceneContact> contacts_;
  std::vector<ExposureRecord> records_;  ///< of the bodies touched so far: the first `recorded_`
  std::size_t recorded_ = 0;
  std::vector<TrackedStep> track_steps_;
  std::vector<TrackedBody> track_;
  bool track_ends_ = false;                ///< the track is full
  double track_step_s_ = 0.0;              ///< length of the last tracked step
  double track_fastest_mps_ = 0.0;         ///< upper bound of the speed of any point of the chain
  const ContactRun* first_run_ = nullptr;  ///< contact with the first body's partner
  std::size_t partner_ = 0;
  double start_s_ = 0.0;
  double now_s_ = 0.0;
  double placed_s_ = 0.0;  ///< middle of the last step, for which near bodies were placed
  double last_force_s_ = 0.0;
  double fastest_plan_mps_ = 0.0;  ///< upper bound of the speed of any point of a planned body
  double fastest_mps_ = 0.0;       ///< the same, also over bodies in contact
  bool over_ = true;
  bool limit_exceeded_ = false;
  std::uint64_t steps_ = 0;
  std::uint64_t ended_work_ = 0;
};

}  // namespace crashrank::detail
