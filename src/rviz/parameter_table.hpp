#pragma once

#include <QTableWidget>
#include <vector>

#include "panel_model.hpp"

namespace sac {

/// Parameters with their uncertainty, a line each.
class ParameterTable : public QTableWidget {
 public:
  ParameterTable();

  /// Instead of those before.
  void fill(const std::vector<ParameterLine>& lines);
};

}  // namespace sac
