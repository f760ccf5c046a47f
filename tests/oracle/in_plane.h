// A ray and a triangle in one plane, decided exactly without rationals.
#pragma once

#include "model/intersect/ray.h"

namespace ctu::oracle {

/// Whether some t in [tmin, tmax] lies in the closed triangle, for a ray whose line lies in one plane with each two of
/// the vertices: all three edge functions are 0. Either the triangle has an area and the line lies in its plane, or it
/// is a segment or a point.
bool meets_in_plane(const intersect::Ray& ray, const Vec3 (&v)[3]);

}  // namespace ctu::oracle
