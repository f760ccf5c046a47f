// What the geometry of influence areas says in exact arithmetic: rationals, and no separating axis.
#pragma once

#include <vector>

#include "model/influence/area.h"
#include "model/influence/convex_polygon.h"

namespace ctu::test {

bool exact_contains(const influence::InfluenceArea& area, const Vec3& point);

/// The exact point of the ray at `t`.
bool exact_contains(const influence::InfluenceArea& area, const intersect::Ray& ray, float t);

/// Closed triangle against closed area: the triangle, cut by the area's half-spaces one after the other, leaves
/// something.
bool exact_touches(const influence::InfluenceArea& area, const Vec3& v0, const Vec3& v1, const Vec3& v2);

/// Closed box against closed area: a face of the box leaves something, or the area is inside the box.
bool exact_touches(const influence::InfluenceArea& area, const Vec3& lower, const Vec3& upper);

/// -1 outside, 0 on the border, +1 inside of a counter-clockwise polygon.
int exact_side(const std::vector<influence::Point2>& polygon, const influence::Point2& point);

/// Twice the area.
double exact_doubled_area(const std::vector<influence::Point2>& polygon);

/// The area that two convex counter-clockwise polygons share, by the paper's A.9: the vertices of each inside the other
/// and the crossings of edges, put in order, and A.10; to binary64.
double exact_common_area(const std::vector<influence::Point2>& a, const std::vector<influence::Point2>& b);

}  // namespace ctu::test
