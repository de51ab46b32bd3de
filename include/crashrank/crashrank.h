#ifndef CRASHRANK_CRASHRANK_H
#define CRASHRANK_CRASHRANK_H

/// \file
/// The C interface, for C11 and for every language that can call C. It is part of the library
/// crashrank, but for the two functions at the end, which read mesh files: those are in
/// crashrank_import. Every answer is the C++ library's.
///
/// Errors: a function that can fail returns a crashrank_status and, where `error` is not NULL,
/// writes the error there. Nothing is written to its other outputs then. No exception leaves
/// a function, nothing is printed, nothing ends the process.
/// Ownership: what a function named *_create, *_load or *_import gives is the caller's, to be given
/// to the *_free of its type; freeing NULL does nothing. Strings and arrays that an object gives
/// belong to it and live as long as it does, where nothing else is said. What is passed in is
/// copied or read during the call only.
/// Threads: different objects may be used from different threads at a time. Rankings do not
/// change and may be shared; so may models and scenarios while nobody changes them. A query belongs
/// to one thread at a time.
/// Strings are UTF-8. Units are SI, angles radians. Frames follow ISO 8855: x forward, y left,
/// z up. A pose is a row-major 4x4 matrix of a rigid motion, 16 numbers, last row 0 0 0 1.
/// Structs that begin with `size`: the caller sets it to sizeof the struct before every call that
/// takes one, and all members to 0 that it does not use. A program compiled against an older header
/// has smaller structs: of what it passes in, missing members take their defaults; of what it asks
/// for, it gets its own members alone. Larger ones are accepted while what this library does not
/// know is 0. Errors: usage for a `size` that no version of the struct has.
/// Enumerations: the values begin at 1; 0 is the default where one is stated, else refused. An
/// error about a member names it, as "crashrank_body.surface".

#include "crashrank/internal/base/export.hpp"

// NOLINTBEGIN(modernize-*,readability-identifier-naming): this is C.
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Rises with every change after which programs compiled before would misunderstand the library.
#define CRASHRANK_ABI_VERSION 2

/// The library's CRASHRANK_ABI_VERSION; other than the header's: do not go on.
CRASHRANK_API int32_t crashrank_abi_version(void);
/// The library's version, "major.minor.patch".
CRASHRANK_API const char* crashrank_version(void);

/// How a call ended.
typedef int32_t crashrank_status;
/// Values of crashrank_status.
enum {
  CRASHRANK_OK = 0,              ///< done
  CRASHRANK_INTERNAL = 1,        ///< the library's or the machine's own failure
  CRASHRANK_USAGE = 2,           ///< a call that has no meaning: NULL, no value of an enumeration
  CRASHRANK_BAD_INPUT = 3,       ///< a file, mesh, scenario or pose is not acceptable
  CRASHRANK_OUT_OF_BUDGET = 4,   ///< a deadline, memory or work budget ended the work
  CRASHRANK_NOT_FOUND = 5,       ///< a file or program is missing or unreadable
  CRASHRANK_LIMIT_EXCEEDED = 6,  ///< input larger than a stated limit
  CRASHRANK_OUT_OF_MEMORY = 7  ///< an allocation failed; nothing was kept, the call may be repeated
};

/// What went wrong, in the caller's memory. A call that succeeds leaves it alone.
typedef struct crashrank_error {
  crashrank_status status;  ///< as the call returned it
  /// One line, "FILE: PLACE: REASON; REMEDY", ended by a zero; names in it are escaped for a
  /// terminal; cut where it is longer.
  char message[508];
} crashrank_error;

/// Bodies' surfaces with the trees over them, a list.
typedef struct crashrank_models crashrank_models;
/// Working memory of collision queries.
typedef struct crashrank_query crashrank_query;
/// One moment of decision: the ego, its candidates, and the actors.
typedef struct crashrank_scenario crashrank_scenario;
/// Candidates in order, least harmful first.
typedef struct crashrank_ranking crashrank_ranking;

// ---- Models -------------------------------------------------------------------------------------

/// An empty list. Errors: out_of_memory.
CRASHRANK_API crashrank_status crashrank_models_create(crashrank_models** models,
                                                       crashrank_error* error);
/// Ends it; NULL is left alone.
CRASHRANK_API void crashrank_models_free(crashrank_models* models);

/// A named run of a model's triangles.
typedef struct crashrank_part {
  const char* name;         ///< unique within the model
  uint32_t triangle_count;  ///< the triangles that follow those of the parts before
} crashrank_part;

/// Builds a model from arrays; its index is the number there were before. `vertices_m`: 3 floats a
/// vertex, body coordinates; `triangles`: 3 vertex indices each. `parts` cover all triangles in
/// order; with none all are one part "body". Errors: usage; bad_input for no triangles, an index
/// out of range, a number that is not finite, parts that do not cover the triangles or share a
/// name; limit_exceeded. O(n log n), allocates.
CRASHRANK_API crashrank_status crashrank_models_add(crashrank_models* models,
                                                    const float* vertices_m, size_t vertex_count,
                                                    const uint32_t* triangles,
                                                    size_t triangle_count,
                                                    const crashrank_part* parts, size_t part_count,
                                                    crashrank_error* error);
/// Adds a model file, as `crashrank compile` writes it: checked whole, and ready in less than ten
/// milliseconds for 100,000 triangles. The mass, centre of mass and yaw inertia that it states
/// count for the shape of this index, each where the scenario gives none. Errors: not_found,
/// bad_input, limit_exceeded.
CRASHRANK_API crashrank_status crashrank_models_load(crashrank_models* models, const char* file,
                                                     crashrank_error* error);
/// Number of models, 0 for NULL.
CRASHRANK_API size_t crashrank_models_size(const crashrank_models* models);
/// Number of triangles of a model, 0 where there is none.
CRASHRANK_API size_t crashrank_models_triangles(const crashrank_models* models, size_t index);
/// Number of parts of a model, 0 where there is none.
CRASHRANK_API size_t crashrank_models_parts(const crashrank_models* models, size_t index);
/// Name of a model's part, NULL where there is none. The list's, until it changes.
CRASHRANK_API const char* crashrank_models_part_name(const crashrank_models* models, size_t index,
                                                     size_t part);

// ---- Collision ----------------------------------------------------------------------------------

/// Triangles of A and B that share a point, by their places in the models.
typedef struct crashrank_pair {
  int32_t a;  ///< triangle of the first model
  int32_t b;  ///< triangle of the second
} crashrank_pair;

/// Working memory for one thread. Errors: out_of_memory.
CRASHRANK_API crashrank_status crashrank_query_create(crashrank_query** query,
                                                      crashrank_error* error);
/// Ends it; NULL is left alone.
CRASHRANK_API void crashrank_query_free(crashrank_query* query);

/// Whether model `b`, at `b_in_a` in the frame of model `a`, shares a point with it: 1 or 0. A body
/// wholly inside the other touches nothing. Exact. Allocates nothing once the query has been used
/// with trees as deep. Errors: usage; bad_input for a pose off a rigid motion by more than 1e-6.
CRASHRANK_API crashrank_status crashrank_collide_any(crashrank_query* query,
                                                     const crashrank_models* models, size_t a,
                                                     size_t b, const double b_in_a[16],
                                                     int32_t* intersecting, crashrank_error* error);
/// How two bodies stand to each other.
typedef int32_t crashrank_body_state;
/// Values of crashrank_body_state.
enum {
  CRASHRANK_SEPARATE = 0,      ///< they share no point, and neither lies inside the other
  CRASHRANK_INTERSECTING = 1,  ///< their surfaces share a point
  CRASHRANK_A_INSIDE_B = 2,    ///< all of the first lies inside the second, or else a part of it
  CRASHRANK_B_INSIDE_A = 3,    ///< the other way round
  CRASHRANK_UNKNOWN_OPEN = 4   ///< a part lies within the bounds of a body that is not closed
};
/// The state of model `b` at `b_in_a`. Exact. The first call for a model that comes near another
/// finds its surfaces, O(n log n), and keeps them in `models`. Otherwise as crashrank_collide_any.
CRASHRANK_API crashrank_status crashrank_collide_state(crashrank_query* query,
                                                       const crashrank_models* models, size_t a,
                                                       size_t b, const double b_in_a[16],
                                                       crashrank_body_state* state,
                                                       crashrank_error* error);
/// All pairs, sorted by a, then b. `pairs` belongs to the query until its next use; not to be read
/// where `count` is 0. Allocates only to hold more pairs than ever before. Otherwise as
/// crashrank_collide_any.
CRASHRANK_API crashrank_status crashrank_collide_all(crashrank_query* query,
                                                     const crashrank_models* models, size_t a,
                                                     size_t b, const double b_in_a[16],
                                                     const crashrank_pair** pairs, size_t* count,
                                                     crashrank_error* error);
/// Fingerprint of sorted pairs, the same on every machine: 16 hex digits and a zero.
CRASHRANK_API crashrank_status crashrank_pairs_hash(const crashrank_pair* pairs, size_t count,
                                                    char hash[17], crashrank_error* error);

// ---- Scenarios ----------------------------------------------------------------------------------

/// Reads a scenario file (data/scenario.schema.json) and finds its meshes, reading none.
/// Errors: bad_input naming the key, limit_exceeded, not_found.
CRASHRANK_API crashrank_status crashrank_scenario_load(const char* file,
                                                       crashrank_scenario** scenario,
                                                       crashrank_error* error);
/// The same from text; `name` stands for the file in messages. Touches no file, so that the models
/// have no paths. Errors: bad_input, limit_exceeded.
CRASHRANK_API crashrank_status crashrank_scenario_create_from_text(const char* text, size_t length,
                                                                   const char* name,
                                                                   crashrank_scenario** scenario,
                                                                   crashrank_error* error);
/// An empty scenario, to be filled by the functions below: no grid of candidates, straight braking
/// not added, horizon 4 s, grip 0.8. Numbers out of range and what does not fit together are
/// refused by crashrank_rank, where nothing else is said.
CRASHRANK_API crashrank_status crashrank_scenario_create(const char* name,
                                                         crashrank_scenario** scenario,
                                                         crashrank_error* error);
/// Ends it; NULL is left alone.
CRASHRANK_API void crashrank_scenario_free(crashrank_scenario* scenario);

/// What a body is.
typedef int32_t crashrank_body_kind;
/// Values of crashrank_body_kind.
enum {
  CRASHRANK_KIND_CAR = 1,
  CRASHRANK_KIND_TRUCK = 2,
  CRASHRANK_KIND_BUS = 3,
  CRASHRANK_KIND_MOTORCYCLE = 4,
  CRASHRANK_KIND_BICYCLE = 5,
  CRASHRANK_KIND_PEDESTRIAN = 6,
  CRASHRANK_KIND_BARRIER = 7,
  CRASHRANK_KIND_POLE = 8,
  CRASHRANK_KIND_BUILDING = 9
};
/// The kind's name in scenario files, "car"; NULL for no value.
CRASHRANK_API const char* crashrank_body_kind_name(crashrank_body_kind kind);

/// Outer material of a body.
typedef int32_t crashrank_surface;
/// Values of crashrank_surface.
enum {
  CRASHRANK_SURFACE_SHEET_METAL = 1,  ///< painted panels of a vehicle
  CRASHRANK_SURFACE_STEEL = 2,        ///< guard rails, steel poles, machinery
  CRASHRANK_SURFACE_CONCRETE = 3,     ///< walls, barriers, masonry
  CRASHRANK_SURFACE_WOOD = 4,         ///< trees, timber posts, fences
  CRASHRANK_SURFACE_RUBBER = 5,       ///< tyres, crash cushions
  CRASHRANK_SURFACE_PERSON = 6        ///< clothing and skin
};
/// The surface's name in scenario files, "sheet-metal"; NULL for no value.
CRASHRANK_API const char* crashrank_surface_name(crashrank_surface surface);

/// Adds a shape; its index is the number added before. `mass_kg` 0: as its model file states, else
/// guessed from kind and size. Errors: usage.
CRASHRANK_API crashrank_status crashrank_scenario_add_model(crashrank_scenario* scenario,
                                                            const char* name,
                                                            crashrank_body_kind kind,
                                                            double mass_kg, crashrank_error* error);

/// What is known of a body besides its shape, kind and mass; 0 and NULL are defaults.
typedef struct crashrank_body {
  size_t size;  ///< sizeof(crashrank_body)
  /// x, y, z in body coordinates, m; NULL: as its model file states, else estimated.
  const double* center_of_mass_m;
  /// About the vertical axis through it, kg m2, at most 1e9; 0: likewise.
  double yaw_inertia_kgm2;
  double stiffness;           ///< crush strength, times the default, 0.01 to 100; 0: 1
  crashrank_surface surface;  ///< 0: by kind
  /// Load at which the foot of a post gives way, which needs a mass; 0 both: never.
  double breakaway_force_n;    ///< horizontal force, N; 0: the moment alone decides
  double breakaway_moment_nm;  ///< moment about the foot, N m; 0: the force alone decides
  double deflection_m;         ///< how far a rail without mass gives way, at most 10 m
  double deflection_force_n;   ///< force at which it does, N; 0: of a rail by EN 1317
} crashrank_body;
/// Sets the known properties of the shape with that index. Errors: usage.
CRASHRANK_API crashrank_status crashrank_scenario_set_body(crashrank_scenario* scenario,
                                                           size_t model, const crashrank_body* body,
                                                           crashrank_error* error);

/// A pose that a body has at a time, s from now.
typedef struct crashrank_timed_pose {
  double time_s;    ///< later than that of the pose before
  double pose[16];  ///< body to world
} crashrank_timed_pose;

/// How the ego moves now.
typedef struct crashrank_ego {
  size_t size;            ///< sizeof(crashrank_ego)
  size_t model;           ///< index of its shape
  double pose[16];        ///< body to world; the origin is the centre of the rear axle
  double speed_mps;       ///< along its forward axis
  double yaw_rate_radps;  ///< left positive
  double wheelbase_m;     ///< 0: 0.6 of the mesh's length
} crashrank_ego;
/// Says how the ego moves. Errors: usage; bad_input for a pose that is no rigid motion.
CRASHRANK_API crashrank_status crashrank_scenario_set_ego(crashrank_scenario* scenario,
                                                          const crashrank_ego* ego,
                                                          crashrank_error* error);

/// Something that can be hit.
typedef struct crashrank_actor {
  size_t size;                        ///< sizeof(crashrank_actor)
  const char* name;                   ///< unique
  size_t model;                       ///< index of its shape
  double pose[16];                    ///< body to world
  double speed_mps;                   ///< along its forward axis
  double acceleration_mps2;           ///< against the speed it brakes, until standstill
  double yaw_rate_radps;              ///< held while it moves
  const crashrank_timed_pose* poses;  ///< where there are any, they say all about its motion
  size_t pose_count;                  ///< 0: they are not read
} crashrank_actor;
/// Adds something that can be hit. Errors: usage; bad_input for a pose that is no rigid motion.
CRASHRANK_API crashrank_status crashrank_scenario_add_actor(crashrank_scenario* scenario,
                                                            const crashrank_actor* actor,
                                                            crashrank_error* error);

/// A motion that an actor may follow.
typedef struct crashrank_motion {
  size_t size;                        ///< sizeof(crashrank_motion)
  double pose[16];                    ///< body to world
  double speed_mps;                   ///< along its forward axis
  double acceleration_mps2;           ///< against the speed it brakes, until standstill
  double yaw_rate_radps;              ///< held while it moves
  const crashrank_timed_pose* poses;  ///< where there are any, they determine the whole motion
  size_t pose_count;                  ///< 0: they are not read
} crashrank_motion;
/// Adds one of the motions that the actor with that index follows with a probability above 0, in
/// place of its own; those of an actor sum to 1, which crashrank_rank checks. Errors: usage;
/// bad_input for a pose that is no rigid motion.
CRASHRANK_API crashrank_status crashrank_scenario_add_prediction(crashrank_scenario* scenario,
                                                                 size_t actor, double probability,
                                                                 const crashrank_motion* motion,
                                                                 crashrank_error* error);
/// Sets the probability that the actor with that index is there at all, 0 to 1. Errors: usage.
CRASHRANK_API crashrank_status crashrank_scenario_set_existence(crashrank_scenario* scenario,
                                                                size_t actor, double probability,
                                                                crashrank_error* error);
/// Sets the standard deviations of the errors of the ego's state, relative to what its candidates
/// assume: of x and of y (m, 0 to 10), of its heading (rad, 0 to pi/4) and, where it moves, of its
/// speed (m/s, 0 to 20). Above 0 the futures are drawn with them; crashrank_rank checks them.
/// Errors: usage.
CRASHRANK_API crashrank_status crashrank_scenario_set_ego_uncertainty(crashrank_scenario* scenario,
                                                                      double position_m,
                                                                      double heading_rad,
                                                                      double speed_mps,
                                                                      crashrank_error* error);
/// Sets the same of the perceived state of the actor with that index, whatever it does;
/// crashrank_rank refuses it for a body that nothing moves. Errors: usage.
CRASHRANK_API crashrank_status crashrank_scenario_set_perception(crashrank_scenario* scenario,
                                                                 size_t actor, double position_m,
                                                                 double heading_rad,
                                                                 double speed_mps,
                                                                 crashrank_error* error);
/// Adds a joint future of all actors, in place of predictions; its index is the number added
/// before. Their probabilities sum to 1, which crashrank_rank checks. Errors: usage.
CRASHRANK_API crashrank_status crashrank_scenario_add_future(crashrank_scenario* scenario,
                                                             double probability,
                                                             crashrank_error* error);
/// Sets the motion of an actor in the future with that index, at most once; without one it follows
/// its own. Errors: usage; bad_input for a pose that is no rigid motion.
CRASHRANK_API crashrank_status crashrank_scenario_add_future_motion(crashrank_scenario* scenario,
                                                                    size_t future, size_t actor,
                                                                    const crashrank_motion* motion,
                                                                    crashrank_error* error);
/// Leaves an actor out of the future with that index: it does not exist in it. At most once, and
/// not where it has a motion there, which crashrank_rank checks. Errors: usage.
CRASHRANK_API crashrank_status crashrank_scenario_add_future_absence(crashrank_scenario* scenario,
                                                                     size_t future, size_t actor,
                                                                     crashrank_error* error);
/// Sets how the scores of several futures become one: "expected" (the default), "worst", "cvar:X"
/// or "quantile:X" with X above 0 and below 1. Errors: usage.
CRASHRANK_API crashrank_status crashrank_scenario_set_risk(crashrank_scenario* scenario,
                                                           const char* risk,
                                                           crashrank_error* error);

/// Number of persons in the ego, 0 to 1000; below 0: the default. Errors: usage for NULL.
CRASHRANK_API crashrank_status crashrank_scenario_set_ego_occupants(crashrank_scenario* scenario,
                                                                    double persons,
                                                                    crashrank_error* error);
/// Number of persons in or on the actor with that index, 0 to 1000; below 0: the default of its
/// kind. Errors: usage.
CRASHRANK_API crashrank_status crashrank_scenario_set_actor_occupants(crashrank_scenario* scenario,
                                                                      size_t actor, double persons,
                                                                      crashrank_error* error);

/// A manoeuvre that the ego can choose: constant acceleration and steering, or timed poses.
typedef struct crashrank_candidate {
  size_t size;                        ///< sizeof(crashrank_candidate)
  const char* name;                   ///< unique
  double acceleration_mps2;           ///< along the forward axis; against the speed it brakes
  double steering_rad;                ///< of the road wheels, left positive
  const crashrank_timed_pose* poses;  ///< where there are any, they say all
  size_t pose_count;                  ///< 0: they are not read
} crashrank_candidate;
/// Adds a manoeuvre. Errors: usage; bad_input for a pose that is no rigid motion.
CRASHRANK_API crashrank_status crashrank_scenario_add_candidate(
    crashrank_scenario* scenario, const crashrank_candidate* candidate, crashrank_error* error);
/// Adds straight braking and a grid of accelerations x steerings inside the grip of the tyres;
/// 0 x 0 takes the grid away.
CRASHRANK_API crashrank_status crashrank_scenario_set_grid(crashrank_scenario* scenario,
                                                           size_t accelerations, size_t steerings,
                                                           crashrank_error* error);
/// Sets how long motions are followed, s, above 0 and at most 60.
CRASHRANK_API crashrank_status crashrank_scenario_set_horizon(crashrank_scenario* scenario,
                                                              double horizon_s,
                                                              crashrank_error* error);
/// Sets the friction between tyre and road, 0.01 to 3.
CRASHRANK_API crashrank_status crashrank_scenario_set_grip(crashrank_scenario* scenario,
                                                           double grip, crashrank_error* error);

/// Limits of the ego; candidates that require more are marked as infeasible. 0 is the default of
/// every member.
typedef struct crashrank_ego_limits {
  size_t size;                     ///< sizeof(crashrank_ego_limits)
  double max_acceleration_mps2;    ///< of the engine; 0: 3
  double max_deceleration_mps2;    ///< of the brakes; 0: as much as the grip
  double max_steering_rad;         ///< of the road wheels; 0: 35 degrees
  double max_steering_rate_radps;  ///< of their angle; 0: 0.4
} crashrank_ego_limits;
/// Sets the limits of the ego. Errors: usage; numbers out of range are refused by crashrank_rank.
CRASHRANK_API crashrank_status crashrank_scenario_set_ego_limits(crashrank_scenario* scenario,
                                                                 const crashrank_ego_limits* limits,
                                                                 crashrank_error* error);

/// Adds an area that the ego may drive on: `corners` holds x and y of each of `count` corners,
/// world, m, in their order around it. Without areas the road has no end. Errors: usage; areas that
/// cross themselves are refused by crashrank_rank.
CRASHRANK_API crashrank_status crashrank_scenario_add_area(crashrank_scenario* scenario,
                                                           const double* corners, size_t count,
                                                           crashrank_error* error);
/// Cuts a hole into the area with that index, as a traffic island. Errors: usage.
CRASHRANK_API crashrank_status crashrank_scenario_add_hole(crashrank_scenario* scenario,
                                                           size_t area, const double* corners,
                                                           size_t count, crashrank_error* error);
/// What leaving the road means: persons added to the harm, at least 0, and the grip beside it, 0:
/// that of the road. Errors: usage for NULL.
CRASHRANK_API crashrank_status crashrank_scenario_set_off_road(crashrank_scenario* scenario,
                                                               double harm_per_leaving, double grip,
                                                               crashrank_error* error);

/// A set of published injury risk curves; crashrank/crash/injury.hpp names their sources.
typedef int32_t crashrank_risk_model;
/// Values of crashrank_risk_model.
enum {
  CRASHRANK_RISK_MODEL_TUM = 1,                ///< MAIS3+
  CRASHRANK_RISK_MODEL_MALLIARIS_MONFORT = 2,  ///< MAIS3+
  CRASHRANK_RISK_MODEL_MALLIARIS_ROSEN = 3,    ///< death
  CRASHRANK_RISK_MODEL_JOKSCH_MONFORT = 4      ///< death
};
/// The risk model's name in scenario files, "malliaris-monfort"; NULL for no value.
CRASHRANK_API const char* crashrank_risk_model_name(crashrank_risk_model model);

/// What the undamaged wheels of a vehicle do after its first contact.
typedef int32_t crashrank_after_contact;
/// Values of crashrank_after_contact.
enum {
  CRASHRANK_AFTER_CONTACT_BRAKES = 1,    ///< brake with one share of the grip, steer as before
  CRASHRANK_AFTER_CONTACT_RELEASES = 2,  ///< roll freely, steer as before
  CRASHRANK_AFTER_CONTACT_LOCKS = 3      ///< no wheel turns
};
/// The name in scenario files, "brakes"; NULL for no value.
CRASHRANK_API const char* crashrank_after_contact_name(crashrank_after_contact after);

/// How harm is counted, as "harm" of a scenario file: a member is named after its key there
/// (weights.pedestrian: weights_pedestrian). 0 is a weight as any other, so begin with what
/// crashrank_scenario_get_harm returns. Ranges are [least, most]; their corners are the samples by
/// which a ranking states how stable it is.
typedef struct crashrank_harm {
  size_t size;                            ///< sizeof(crashrank_harm)
  crashrank_risk_model risk_model;        ///< published curves
  crashrank_after_contact after_contact;  ///< of all vehicles that were hit
  double weights_ego_occupant;            ///< of a person in the ego, 0 to 1e6
  double weights_other_occupant;          ///< of a person in another vehicle, 0 to 1e6
  double weights_pedestrian;              ///< of a person on foot, 0 to 1e6
  double weights_cyclist;                 ///< of a person on a bicycle, 0 to 1e6
  double weights_motorcyclist;            ///< of a person on a motorcycle, 0 to 1e6
  double weights_property_per_mj;         ///< of every MJ of deformation, 0 to 1e6
  double people_ego;                      ///< persons in the ego, 0 to 1000
  double people_car;                      ///< persons in every car, 0 to 1000
  double people_truck;                    ///< persons in every truck, 0 to 1000
  double people_bus;                      ///< persons in every bus, 0 to 1000
  double pedestrian_age_years;   ///< of all pedestrians, 0 to 120; below 0: the curve's mean person
  double pedestrian_male_share;  ///< probability, 0 to 1; below 0: likewise
  double friction;               ///< of two painted panels, other surfaces in proportion, 0 to 10
  double ranges_friction[2];     ///< of that, each 0 to 10
  double ranges_strength[2];     ///< times the strength of all bodies, each 0.01 to 100
  double ranges_restitution[2];  ///< times that of the contact law, each 0 to 10
  double ranges_risk_speed[2];   ///< times the speed at which risk is read, each 0.1 to 10
  int32_t ranges_all_models;     ///< other than 0: samples of every risk model, not of one alone
} crashrank_harm;
/// How the scenario counts harm: the caller sets `harm->size`. Errors: usage.
CRASHRANK_API crashrank_status crashrank_scenario_get_harm(const crashrank_scenario* scenario,
                                                           crashrank_harm* harm,
                                                           crashrank_error* error);
/// Sets how the scenario counts harm. Members that a smaller struct lacks stay as they are. Errors:
/// usage; bad_input for a number that is not finite or out of range. The scenario is then as
/// before.
CRASHRANK_API crashrank_status crashrank_scenario_set_harm(crashrank_scenario* scenario,
                                                           const crashrank_harm* harm,
                                                           crashrank_error* error);
/// Reads a profile of weights (data/profile.schema.json); what it leaves out stays as the scenario
/// has it. Errors: bad_input naming the key, limit_exceeded (1 MiB), not_found. The scenario is
/// then as before.
CRASHRANK_API crashrank_status crashrank_scenario_load_profile(crashrank_scenario* scenario,
                                                               const char* file,
                                                               crashrank_error* error);
/// The same from text; `name` stands for the file in messages.
CRASHRANK_API crashrank_status
crashrank_scenario_set_profile_from_text(crashrank_scenario* scenario, const char* text,
                                         size_t length, const char* name, crashrank_error* error);

/// Number of shapes, in the order in which crashrank_rank wants their models. 0 for NULL.
CRASHRANK_API size_t crashrank_scenario_model_count(const crashrank_scenario* scenario);
/// Name of a shape, NULL where there is none.
CRASHRANK_API const char* crashrank_scenario_model_name(const crashrank_scenario* scenario,
                                                        size_t index);
/// Where its mesh is: empty unless crashrank_scenario_load found it, NULL where there is none.
CRASHRANK_API const char* crashrank_scenario_model_path(const crashrank_scenario* scenario,
                                                        size_t index);

// ---- Ranking ------------------------------------------------------------------------------------

/// What a ranking compares. Every measure is 0 without contact, and lower is better.
typedef int32_t crashrank_measure;
/// Values of crashrank_measure.
enum {
  CRASHRANK_MEASURE_POLYGONS = 1,        ///< triangles that intersect, of both bodies
  CRASHRANK_MEASURE_AREA = 2,            ///< area of those triangles, m2
  CRASHRANK_MEASURE_CLOSING_ENERGY = 3,  ///< of the closing speed of first contacts, J
  CRASHRANK_MEASURE_DELTA_V = 4,         ///< the ego's change of velocity, m/s
  CRASHRANK_MEASURE_ENERGY = 5,          ///< kinetic energy turned into damage and heat, J
  CRASHRANK_MEASURE_INTRUSION = 6,       ///< crush into passengers' cages, m
  CRASHRANK_MEASURE_HARM = 7             ///< people hurt, as crashrank_harm counts them
};
/// The measure's name in scenario files, "closing-energy"; NULL for no value.
CRASHRANK_API const char* crashrank_measure_name(crashrank_measure measure);

/// What becomes of manoeuvres that the vehicle cannot follow.
typedef int32_t crashrank_infeasible;
/// Values of crashrank_infeasible.
enum {
  CRASHRANK_INFEASIBLE_DEMOTE = 1,  ///< they rank behind all feasible ones
  CRASHRANK_INFEASIBLE_DROP = 2,    ///< they are left out, unless there is no feasible one
  CRASHRANK_INFEASIBLE_KEEP = 3     ///< they are ranked like all others
};

/// What orders the candidates.
typedef int32_t crashrank_order;
/// Values of crashrank_order.
enum {
  CRASHRANK_ORDER_SCORE = 1,  ///< the score
  CRASHRANK_ORDER_UPPER = 2   ///< the upper end of its interval; crashrank_rank alone
};

/// How candidates are ranked; 0 is the default of every member.
typedef struct crashrank_rank_options {
  size_t size;                ///< sizeof(crashrank_rank_options)
  crashrank_measure measure;  ///< 0: as the scenario says (a scenario made here: harm)
  uint32_t workers;           ///< threads that share the work, 64 at most; the answer is the same
  int32_t json;               ///< other than 0: crashrank_ranking_json has an answer
  crashrank_order order;      ///< 0: CRASHRANK_ORDER_SCORE
  crashrank_infeasible infeasible;  ///< 0: CRASHRANK_INFEASIBLE_DEMOTE
  int64_t motion;                   ///< other than 0: crashrank_ranking_motion has motions
  int64_t smooth;  ///< other than 0: scores are means over small errors of all states
} crashrank_rank_options;

/// Ranks the candidates by the harm or damage of their crashes. The model with index i is that of
/// the shape with index i. `options` may be NULL. Errors: usage (number of models, measure),
/// bad_input, internal. Cost: about the candidates times the bodies they come near. Allocates, may
/// start threads.
CRASHRANK_API crashrank_status crashrank_rank(const crashrank_scenario* scenario,
                                              const crashrank_models* models,
                                              const crashrank_rank_options* options,
                                              crashrank_ranking** ranking, crashrank_error* error);
/// Ends it; NULL is left alone.
CRASHRANK_API void crashrank_ranking_free(crashrank_ranking* ranking);

/// Above this closing speed no crash can be simulated, m/s: the measures harm, delta-v, energy and
/// intrusion do not hold there, closing-energy does.
#define CRASHRANK_FASTEST_CRASH_MPS 140.0

/// Outcome of a candidate. Of contacts the first is reported; without one its numbers are
/// NaN.
typedef struct crashrank_choice {
  size_t size;                 ///< sizeof(crashrank_choice)
  const char* candidate;       ///< its name; the ranking's
  const char* other;           ///< name of the body hit first, NULL if none; the ranking's
  double score;                ///< in the measure's unit, lower is better, 0 without contact; NaN
                               ///< where only the interval is known
  double lowest_score;         ///< the interval that contains the score
  double highest_score;        ///< and its upper end
  double time_of_impact_s;     ///< from now
  double closing_speed_mps;    ///< of the points that touch; see CRASHRANK_FASTEST_CRASH_MPS
  double delta_v_mps;          ///< the ego's change of velocity, magnitude
  double other_delta_v_mps;    ///< and that of the body hit
  double pdof_deg;             ///< where the force on the ego comes from, clockwise from ahead
  uint64_t damaged_triangles;  ///< of the ego, from all contacts
  uint64_t contacts;           ///< of the ego; for those between others see
                               ///< crashrank_ranking_further_count
  /// 1: in a future, meshes of the ego and another body touch at more than 0.5 m/s and the crash
  /// model finds no force in time. The score may be too low; `highest_score` is what the energy
  /// allows.
  int32_t contact_without_force;
} crashrank_choice;

/// Number of candidates, 0 for NULL.
CRASHRANK_API size_t crashrank_ranking_size(const crashrank_ranking* ranking);
/// The candidate in a place, 0 the least harmful: the caller sets `choice->size`. Errors: usage.
CRASHRANK_API crashrank_status crashrank_ranking_get(const crashrank_ranking* ranking, size_t place,
                                                     crashrank_choice* choice,
                                                     crashrank_error* error);
/// A contact between two bodies neither of which is the ego, one of which was hit before.
typedef struct crashrank_further_contact {
  size_t size;               ///< sizeof(crashrank_further_contact)
  const char* a;             ///< name of the one body; the ranking's
  const char* b;             ///< and of the other
  double time_s;             ///< when it begins, from now
  double closing_speed_mps;  ///< relative speed as it begins, where its force acts
  double a_delta_v_mps;      ///< change of velocity of a, magnitude
  double b_delta_v_mps;      ///< and of b
  double harm;               ///< persons, as weighted; NaN unless the measure is harm
} crashrank_further_contact;

/// Number of contacts between others that follow from the candidate that crashrank_ranking_get has
/// under `index`; 0 for NULL, and where there is no such index.
CRASHRANK_API size_t crashrank_ranking_further_count(const crashrank_ranking* ranking,
                                                     size_t index);
/// One of them, by their begins; `contact` is its index from 0, and the caller sets
/// `further->size`. Errors: usage.
CRASHRANK_API crashrank_status crashrank_ranking_further(const crashrank_ranking* ranking,
                                                         size_t index, size_t contact,
                                                         crashrank_further_contact* further,
                                                         crashrank_error* error);
/// Simulated motion of the centre of mass of a body that contact forces acted on, in the likeliest
/// future: from its state before the first force to the end of the simulation. World axes. The
/// arrays are the ranking's and have `count` elements.
typedef struct crashrank_body_motion {
  size_t size;                   ///< sizeof(crashrank_body_motion)
  const char* body;              ///< name of the actor, "ego" for the ego; the ranking's
  size_t count;                  ///< number of times
  const double* t_s;             ///< from now, rising
  const double* x_m;             ///< position
  const double* y_m;             ///< position
  const double* yaw_rad;         ///< heading from x, left positive
  const double* vx_mps;          ///< velocity
  const double* vy_mps;          ///< velocity
  const double* yaw_rate_radps;  ///< left positive
  const uint8_t* pressed;        ///< 1: a contact force acted since the time before
} crashrank_body_motion;

/// Number of bodies with a motion of the candidate that crashrank_ranking_get has under `index`; 0
/// without crashrank_rank_options.motion, for NULL, and where there is no such index.
CRASHRANK_API size_t crashrank_ranking_motion_count(const crashrank_ranking* ranking, size_t index);
/// One of them, the ego first, then in the order of the actors; `body` is its index from 0, and the
/// caller sets `motion->size`. Errors: usage.
CRASHRANK_API crashrank_status crashrank_ranking_motion(const crashrank_ranking* ranking,
                                                        size_t index, size_t body,
                                                        crashrank_body_motion* motion,
                                                        crashrank_error* error);
/// Properties of a candidate besides its crash; absent ones are NaN.
typedef struct crashrank_manoeuvre {
  size_t size;             ///< sizeof(crashrank_manoeuvre)
  int32_t feasible;        ///< 1: the vehicle can follow it to its first contact; else 0
  int32_t leaves_road;     ///< 1: a wheel leaves the road before the first contact in any future
  double grip_demand;      ///< what it requires over what is available: of the tyres' grip
  double engine_demand;    ///< of the engine
  double brakes_demand;    ///< of the brakes
  double steering_demand;  ///< of the steering angle
  double steering_rate_demand;  ///< of its rate
  double leaves_road_s;         ///< when, from now
  double leaves_road_mps;       ///< and how fast
  double least_distance_m;      ///< to other bodies along the plans, 0 if it has a contact
  double least_time_gap_s;      ///< between it and another that moves, at one place
  double horizon_speed_mps;     ///< at the horizon, if it has no contact
  /// From the horizon until it touches another, if all keep their velocities; absent above 3 s and
  /// if it has a contact.
  double time_to_collision_s;
} crashrank_manoeuvre;
/// Properties of the candidate under `index` besides its crash; the caller sets
/// `manoeuvre->size`. Errors: usage.
CRASHRANK_API crashrank_status crashrank_ranking_manoeuvre(const crashrank_ranking* ranking,
                                                           size_t index,
                                                           crashrank_manoeuvre* manoeuvre,
                                                           crashrank_error* error);
/// The place of the candidate that crashrank_ranking_get has under `index`, from 1: candidates that
/// are tied share it (1, 2, 2, 4) and have neighbouring indices. `sharing`, which may be NULL: how
/// many candidates have that place. Errors: usage.
CRASHRANK_API crashrank_status crashrank_ranking_place(const crashrank_ranking* ranking,
                                                       size_t index, size_t* place, size_t* sharing,
                                                       crashrank_error* error);
/// Whether the candidate under `index` is separable from the next one: 1 or 0, -1 where the scores
/// read simulated crashes and no samples were taken (or it is the last). 0 where they tie, score
/// alike, the order reverses in more than 5 % of the samples, or longer steps or 1 mm aside
/// may turn it. Errors: usage.
CRASHRANK_API crashrank_status crashrank_ranking_separable(const crashrank_ranking* ranking,
                                                           size_t index, int32_t* separable,
                                                           crashrank_error* error);
/// Unit of the scores: "triangles", "m2", "J", "m/s", "m", "persons". NULL for NULL.
CRASHRANK_API const char* crashrank_ranking_unit(const crashrank_ranking* ranking);
/// The whole answer as `crashrank rank --json` prints it (data/schemas/rank.schema.json), ended by
/// a zero; the ranking's. NULL where the options did not ask for it.
CRASHRANK_API const char* crashrank_ranking_json(const crashrank_ranking* ranking);

// ---- Ranking against a deadline -----------------------------------------------------------------

/// Ranks repeatedly in memory that is allocated once.
typedef struct crashrank_ranker crashrank_ranker;

/// What a ranker ranks by and sets aside; 0 is the default of every member.
typedef struct crashrank_ranker_options {
  size_t size;                ///< sizeof(crashrank_ranker_options)
  crashrank_measure measure;  ///< 0: as the scenario says
  uint32_t workers;           ///< the calling thread and `workers` - 1 more, 64 at most
  uint32_t most_candidates;   ///< memory is set aside for so many; 0: 1024
  uint32_t most_actors;       ///< 0: 64
} crashrank_ranker_options;

/// Sets up workers, memory and the scenario's situation. `models`, which have to stay as they are
/// for as long as the ranker lives, belong to the scenario's shapes as in crashrank_rank.
/// Errors: as crashrank_rank; usage where the limits are exceeded. Allocates, starts threads.
CRASHRANK_API crashrank_status crashrank_ranker_create(const crashrank_scenario* scenario,
                                                       const crashrank_models* models,
                                                       const crashrank_ranker_options* options,
                                                       crashrank_ranker** ranker,
                                                       crashrank_error* error);
/// Ends it, and its workers; NULL is left alone.
CRASHRANK_API void crashrank_ranker_free(crashrank_ranker* ranker);
/// The situation has changed: takes the ego's pose and speed, the motions of the actors and the
/// candidates from a scenario. Allocates. Errors: usage for more candidates than the limit, and
/// where shapes, their kinds or masses, the ego's or an actor's shape, their number, the horizon,
/// the grip or the harm is not what the ranker was created with; bad_input. The ranker then keeps
/// its situation. Actors enter and leave: one whose existence_probability was 0 at creation, with
/// one motion, a shape that moves and no joint futures, keeps a place. An update may give it 1,
/// with any shape of the scenario that moves and any occupants, and 0 again; until then no future
/// has it, and it costs next to nothing. Answers are those of a ranker created with the update.
CRASHRANK_API crashrank_status crashrank_ranker_update(crashrank_ranker* ranker,
                                                       const crashrank_scenario* scenario,
                                                       crashrank_error* error);

/// When a ranking ends at the latest.
typedef struct crashrank_budget {
  size_t size;               ///< sizeof(crashrank_budget)
  double deadline_s;         ///< counted from the call; 0: none, below: already over
  uint64_t work;             ///< in tests, deterministic; 0: none
  int32_t first_place_only;  ///< other than 0: ends as soon as the first place is proved
} crashrank_budget;

/// A candidate of an answer. What is not known is NaN.
typedef struct crashrank_ranked {
  uint64_t candidate;        ///< index, see crashrank_ranker_candidate_name
  double score;              ///< the final one
  double lowest_score;       ///< the interval contains the final score, whatever was left undone
  double highest_score;      ///< and its upper end
  double time_of_impact_s;   ///< from now
  double closing_speed_mps;  ///< of the points that touch; see CRASHRANK_FASTEST_CRASH_MPS
  double collision_probability;   ///< over all futures, as far as it is known
  double estimated_score;         ///< estimate of the score; the score where it is known
  int32_t in_race;                ///< can still be first
  int32_t collides;               ///< in the likeliest future, as far as it is known
  int32_t contact_without_force;  ///< as in crashrank_choice; 0 where the score is not known
} crashrank_ranked;

/// What the first place of an answer rests on.
enum {
  CRASHRANK_BASIS_BRAKING = 1,    ///< nothing known shows a better one than braking hardest
  CRASHRANK_BASIS_COARSE = 2,     ///< it keeps clear of everybody by an estimate
  CRASHRANK_BASIS_SIMULATED = 3,  ///< its score is known, and no known one is better
  CRASHRANK_BASIS_PROVED = 4      ///< no other candidate can take it
};

/// What was known in time. `ranking`, most promising first, is the ranker's until its next call.
typedef struct crashrank_answer {
  size_t size;                      ///< sizeof(crashrank_answer)
  const crashrank_ranked* ranking;  ///< every candidate once
  size_t count;                     ///< of the ranking
  size_t in_race;                   ///< how many can still be first
  uint64_t hash;     ///< of the ranking, the same on every machine whenever the answer is
  double elapsed_s;  ///< from the call on
  int32_t complete;  ///< every score is known
  int32_t proved;    ///< no other candidate can still take the first place
  int32_t basis;     ///< of the first place: one of CRASHRANK_BASIS_...
} crashrank_answer;

/// Ranks within a budget; NULL: without end. The caller sets `answer->size`. Allocates nothing, and
/// blocks for its own workers alone (crashrank/rank/anytime/ranker.hpp names the measures whose
/// last stage allocates). One thread at a time for each ranker. Errors: usage; bad_input for a
/// situation that cannot be computed with.
CRASHRANK_API crashrank_status crashrank_ranker_rank(crashrank_ranker* ranker,
                                                     const crashrank_budget* budget,
                                                     crashrank_answer* answer,
                                                     crashrank_error* error);
/// Name of a candidate, NULL where there is none. The ranker's, until its next update.
CRASHRANK_API const char* crashrank_ranker_candidate_name(const crashrank_ranker* ranker,
                                                          size_t candidate);

// ---- Mesh files: in the library crashrank_import ------------------------------------------------

/// Reads a mesh file (OBJ, STL, PLY, OFF, glTF, Collada, FBX, 3DS, AC3D) as it stands, in a process
/// of its own, or a model file here, and adds its model. Blocks until that has ended. Errors:
/// bad_input, not_found, limit_exceeded; internal where the importer cannot be started. The program
/// crashrank-import is the one that the environment variable CRASHRANK_IMPORTER names, else the
/// first that exists of: beside this program, in the installation of this program, of the shared
/// library, of `header`, and where the library was configured to be installed. `header` is the path
/// of this file as installed, ignored unless absolute; NULL: none.
CRASHRANK_API crashrank_status crashrank_models_import_with_header(crashrank_models* models,
                                                                   const char* file,
                                                                   const char* header,
                                                                   crashrank_error* error);
/// Adds the models of all shapes of a loaded scenario, in their order, read as the scenario says;
/// none where one fails; what model files state counts as crashrank_models_load says. Errors as
/// above; usage for a shape without a path.
CRASHRANK_API crashrank_status crashrank_models_import_scenario_with_header(
    crashrank_models* models, const crashrank_scenario* scenario, const char* header,
    crashrank_error* error);

// The two as programs in C and C++ call them. A static library has no place of its own from which
// it could find the importer, but the header that a program includes has: compiled here, __FILE__
// follows a moved prefix without a compile definition.

/// crashrank_models_import_with_header with this header.
static inline crashrank_status crashrank_models_import(crashrank_models* models, const char* file,
                                                       crashrank_error* error) {
  return crashrank_models_import_with_header(models, file, __FILE__, error);
}
/// crashrank_models_import_scenario_with_header with this header.
static inline crashrank_status crashrank_models_import_scenario(crashrank_models* models,
                                                                const crashrank_scenario* scenario,
                                                                crashrank_error* error) {
  return crashrank_models_import_scenario_with_header(models, scenario, __FILE__, error);
}

#ifdef __cplusplus
}
#endif
// NOLINTEND(modernize-*,readability-identifier-naming)

#endif
