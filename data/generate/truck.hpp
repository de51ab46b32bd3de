#pragma once

#include "mesh.hpp"

#include <string>

namespace generate {

/// A two-axle rigid lorry with box body and cab over the engine, origin on the ground under the
/// rear axle. Its tail ends high above the road over an under-run bar.
Model build_truck(double edge);

/// The lorry's cab with engine and wheel housings, 5.50 m before the origin over its front axle;
/// it reaches from x = 4.94 to 6.97 m.
void add_cab(double edge, Model* model);

/// The wheels of the axle below that cab.
void add_front_wheels(double edge, Model* model);

/// Twin wheels of an axle as `wheel_PLACE` and `rim_PLACE`, 1.0 m in diameter.
void add_twin_wheels(double x, const std::string& place, double edge, Model* model);

/// A beam between two wheels.
void add_axle(double x, double z, const std::string& place, double edge, Model* model);

/// A guard over each pair of twin wheels.
void add_mudguards(double axle_x, const std::string& place, Model* model);

/// A load box, each of its sides a part.
void add_load_box(const Vec3& center, const Vec3& half, double edge, Model* model);

/// Under-run bar and lamps of a load box that ends at x = `tail`.
void add_tail(double tail, double edge, Model* model);

}  // namespace generate
