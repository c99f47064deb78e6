#pragma once

#include <QPushButton>
#include <QTableWidget>
#include <QWidget>
#include <cstdint>
#include <functional>
#include <vector>

#include "panel_model.hpp"

namespace sac {

/// The samples of the last cycle, worst first, of which one can be taken out of use.
class SampleTable : public QWidget {
 public:
  /// `remove` is called with the id of the sample that the operator has chosen.
  explicit SampleTable(std::function<void(std::uint32_t)> remove);

  /// Instead of those before; the choice stays where its sample does.
  void fill(std::vector<SampleLine> lines);
  QPushButton* removeButton() const { return remove_; }

 private:
  void showChoice();

  std::vector<SampleLine> lines_;
  QTableWidget* table_;
  QPushButton* remove_;
};

}  // namespace sac
