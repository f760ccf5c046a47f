// The current transformation matrix of a .pbrt: the statements that change it, and the blocks that restore it.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "model/scene/affine.h"
#include "model/scene/draft.h"
#include "model/scene/pbrt_text.h"

namespace ctu::scene {

class PbrtMatrix {
 public:
  explicit PbrtMatrix(Draft& draft) : draft_(draft) {}

  /// The names of the statements that take() knows.
  static const std::vector<std::string>& statements();
  /// Obeys the statement `name`, whose arguments follow in `text`; false if it is none of ours.
  bool take(std::string_view name, PbrtText& text);

  const Affine& current() const { return current_; }
  /// Every block pushes one and the same stack: San Miguel closes its blocks in crossed order.
  void push(const PbrtText& text);
  void pop(const PbrtText& text);
  /// What CoordSysTransform will find under this name.
  void remember(const std::string& name, const Affine& matrix) { systems_[name] = matrix; }
  /// WorldBegin: from here on the identity is the world.
  void begin_world();

 private:
  void set(const Affine& matrix);
  void move(const Affine& matrix);
  void rotate(PbrtText& text);
  void look_at(PbrtText& text);
  void coordinate_system(PbrtText& text);
  void active_transform(PbrtText& text);

  Draft& draft_;
  Affine current_;
  std::vector<Affine> stack_;
  std::map<std::string, Affine> systems_;
  bool at_start_ = true;  ///< scenes with motion state transforms for the end of the exposure too; the start counts
};

}  // namespace ctu::scene
