#ifndef CRASHRANK_CRASHRANK_H
#define CRASHRANK_CRASHRANK_H

/// \file
/// The C interface, for C11 and for every language that can call C. It stands in the library
/// crashrank, but for the two functions at the end, which read mesh files: those are in
/// crashrank_import. Every answer is the C++ library's.
///
/// Errors: a function that can fail returns a crashrank_status and, where `error` is not NULL,
/// writes there what went wrong. Nothing is written to its other outputs then. No exception leaves
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

#include "crashrank/internal/base/export.hpp"

// NOLINTBEGIN(modernize-*): this is C.
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Rises with every change after which programs compiled before would misunderstand the library.
#define CRASHRANK_ABI_VERSION 1

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
  CRASHRANK_USAGE = 2,           ///< a call that has no meaning: NULL, an index out of range
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
/// One moment of decision: the ego, what it can do, who else is there.
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
/// wholly inside the other touches nothing. Exact. Allocates nothing once the query has met trees
/// as deep. Errors: usage; bad_input for a pose off a rigid motion by more than 1e-6.
CRASHRANK_API crashrank_status crashrank_collide_any(crashrank_query* query,
                                                     const crashrank_models* models, size_t a,
                                                     size_t b, const double b_in_a[16],
                                                     int32_t* intersecting, crashrank_error* error);
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
/// not added, horizon 4 s, grip 0.8. What does not fit together is found by crashrank_rank.
CRASHRANK_API crashrank_status crashrank_scenario_create(const char* name,
                                                         crashrank_scenario** scenario,
                                                         crashrank_error* error);
/// Ends it; NULL is left alone.
CRASHRANK_API void crashrank_scenario_free(crashrank_scenario* scenario);

/// Adds a shape; its index is the number added before. `kind`: car, truck, bus, motorcycle,
/// bicycle, pedestrian, barrier, pole or building; `mass_kg` 0: as its model file states,
/// else guessed from kind and size.
CRASHRANK_API crashrank_status crashrank_scenario_add_model(crashrank_scenario* scenario,
                                                            const char* name, const char* kind,
                                                            double mass_kg, crashrank_error* error);

/// What is known of a body besides its shape, kind and mass. Begin with all zero: that is the
/// default of everything.
typedef struct crashrank_body {
  /// x, y, z in body coordinates, m; NULL: as its model file states, else estimated.
  const double* center_of_mass_m;
  /// About the vertical axis through it, kg m2, at most 1e9; 0: likewise.
  double yaw_inertia_kgm2;
  double stiffness;     ///< crush strength, times the default, 0.01 to 100; 0: 1
  const char* surface;  ///< sheet-metal, steel, concrete, wood, rubber or person; NULL: by kind
} crashrank_body;
/// Sets what is known of the shape with that index. Errors: usage. Numbers out of range are found
/// by crashrank_rank.
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
/// How long the motions are looked at, s, and the friction between tyre and road.
CRASHRANK_API crashrank_status crashrank_scenario_set_horizon(crashrank_scenario* scenario,
                                                              double horizon_s, double grip,
                                                              crashrank_error* error);

/// Number of shapes, in the order in which crashrank_rank wants their models. 0 for NULL.
CRASHRANK_API size_t crashrank_scenario_model_count(const crashrank_scenario* scenario);
/// Name of a shape, NULL where there is none.
CRASHRANK_API const char* crashrank_scenario_model_name(const crashrank_scenario* scenario,
                                                        size_t index);
/// Where its mesh is: empty unless crashrank_scenario_load found it, NULL where there is none.
CRASHRANK_API const char* crashrank_scenario_model_path(const crashrank_scenario* scenario,
                                                        size_t index);

// ---- Ranking ------------------------------------------------------------------------------------

/// Begin with all zero: that is the default of everything.
typedef struct crashrank_rank_options {
  const char* measure;  ///< polygons, area, closing-energy, delta-v, energy, intrusion or harm;
                        ///< NULL: as the scenario says (a scenario made here: harm)
  uint32_t workers;     ///< threads that share the work, 64 at most; the answer is the same
  int32_t json;         ///< other than 0: crashrank_ranking_json has an answer
} crashrank_rank_options;

/// Ranks the candidates by what they would destroy. The model with index i is that of the shape
/// with index i. `options` may be NULL. Errors: usage (number of models, measure), bad_input,
/// internal. Cost: about the candidates times the bodies they come near. Allocates, may start
/// threads.
CRASHRANK_API crashrank_status crashrank_rank(const crashrank_scenario* scenario,
                                              const crashrank_models* models,
                                              const crashrank_rank_options* options,
                                              crashrank_ranking** ranking, crashrank_error* error);
/// Ends it; NULL is left alone.
CRASHRANK_API void crashrank_ranking_free(crashrank_ranking* ranking);

/// Above this closing speed no crash can be simulated, m/s: the measures harm, delta-v, energy and
/// intrusion do not hold there, closing-energy does.
#define CRASHRANK_FASTEST_CRASH_MPS 140.0

/// What choosing a candidate leads to. Of contacts the first is told; without one its numbers are
/// NaN.
typedef struct crashrank_choice {
  const char* candidate;       ///< its name; the ranking's
  const char* other;           ///< who is hit first, NULL for nobody; the ranking's
  double score;                ///< in the measure's unit, lower is better, 0 without contact; NaN
                               ///< where only the interval is known
  double lowest_score;         ///< the interval that contains the score
  double highest_score;        ///< and its upper end
  double time_of_impact_s;     ///< from now
  double closing_speed_mps;    ///< of the points that meet; see CRASHRANK_FASTEST_CRASH_MPS
  double delta_v_mps;          ///< the ego's change of velocity, magnitude
  double other_delta_v_mps;    ///< and that of who is hit
  double pdof_deg;             ///< where the force on the ego comes from, clockwise from ahead
  uint64_t damaged_triangles;  ///< of the ego, from all contacts
  uint64_t contacts;           ///< of the ego; for those between others see
                               ///< crashrank_ranking_further_count
} crashrank_choice;

/// Number of candidates, 0 for NULL.
CRASHRANK_API size_t crashrank_ranking_size(const crashrank_ranking* ranking);
/// The candidate in a place, 0 the least harmful. Errors: usage.
CRASHRANK_API crashrank_status crashrank_ranking_get(const crashrank_ranking* ranking, size_t place,
                                                     crashrank_choice* choice,
                                                     crashrank_error* error);
/// A contact between two bodies neither of which is the ego, one of which was hit before.
typedef struct crashrank_further_contact {
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
/// One of them, by their begins; `contact` is its index from 0. Errors: usage.
CRASHRANK_API crashrank_status crashrank_ranking_further(const crashrank_ranking* ranking,
                                                         size_t index, size_t contact,
                                                         crashrank_further_contact* further,
                                                         crashrank_error* error);
/// The place of the candidate that crashrank_ranking_get has under `index`, from 1: candidates that
/// are tied share it (1, 2, 2, 4) and have neighbouring indices. `sharing`, which may be NULL: how
/// many candidates have that place. Errors: usage.
CRASHRANK_API crashrank_status crashrank_ranking_place(const crashrank_ranking* ranking,
                                                       size_t index, size_t* place, size_t* sharing,
                                                       crashrank_error* error);
/// Whether the candidate under `index` can be told from the next one: 1 or 0, -1 where the scores
/// read simulated crashes and no samples were taken (or it is the last). 0 where they tie, score
/// alike, the order turns round in more than 5 % of the samples, or half the steps or 1 mm aside
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

/// Ranks again and again in memory set aside once.
typedef struct crashrank_ranker crashrank_ranker;

/// Begin with all zero: that is the default of everything.
typedef struct crashrank_ranker_options {
  const char* measure;       ///< as in crashrank_rank_options
  uint32_t workers;          ///< the calling thread and `workers` - 1 more, 64 at most
  uint32_t most_candidates;  ///< memory is set aside for so many; 0: 1024
  uint32_t most_actors;      ///< 0: 64
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
/// where shapes, their kinds or masses, the ego's or an actor's shape, their number or the horizon
/// is not what the ranker was created with; bad_input. The ranker then keeps its situation.
CRASHRANK_API crashrank_status crashrank_ranker_update(crashrank_ranker* ranker,
                                                       const crashrank_scenario* scenario,
                                                       crashrank_error* error);

/// When a ranking ends at the latest.
typedef struct crashrank_budget {
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
  double closing_speed_mps;  ///< of the points that meet; see CRASHRANK_FASTEST_CRASH_MPS
  int32_t in_race;           ///< can still be first
  int32_t collides;          ///< as far as it is known
} crashrank_ranked;

/// What was known in time. `ranking`, most promising first, is the ranker's until its next call.
typedef struct crashrank_answer {
  const crashrank_ranked* ranking;  ///< every candidate once
  size_t size;                      ///< of the ranking
  size_t in_race;                   ///< how many can still be first
  uint64_t hash;     ///< of the ranking, the same on every machine whenever the answer is
  double elapsed_s;  ///< from the call on
  int32_t complete;  ///< every score is known
  int32_t proved;    ///< no other candidate can still take the first place
} crashrank_answer;

/// Ranks within a budget; NULL: without end. Allocates nothing, and blocks for its own workers
/// alone (crashrank/rank/anytime/ranker.hpp names the measures whose last stage allocates). One
/// thread at a time for each ranker. Errors: usage; bad_input for a situation that cannot be
/// computed with.
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
/// crashrank-import is looked for where the environment variable CRASHRANK_IMPORTER says, beside
/// this program, and where the library was configured to be installed.
CRASHRANK_API crashrank_status crashrank_models_import(crashrank_models* models, const char* file,
                                                       crashrank_error* error);
/// Adds the models of all shapes of a loaded scenario, in their order, read as the scenario says;
/// none where one fails; what model files state counts as crashrank_models_load says. Errors as
/// above; usage for a shape without a path.
CRASHRANK_API crashrank_status crashrank_models_import_scenario(crashrank_models* models,
                                                                const crashrank_scenario* scenario,
                                                                crashrank_error* error);

#ifdef __cplusplus
}
#endif
// NOLINTEND(modernize-*)

#endif
