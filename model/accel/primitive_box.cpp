#include "model/accel/primitive_box.h"

#include "model/accel/node_box.h"

namespace ctu::accel {

PrimitiveBox box_of_primitive(const LeafTriangle& primitive) {
  const Box3 box = box_of_triangles(&primitive, 1);
  return {to_vec3(box.lower), to_vec3(box.upper)};
}

}  // namespace ctu::accel
