#include "sample_table.hpp"

#include <QVBoxLayout>
#include <string>
#include <utility>

#include "choice_table.hpp"

namespace sac {

SampleTable::SampleTable(std::function<void(std::uint32_t)> remove)
    : table_(choiceTable({"sample", "quantity", "at", "residual", "of expected", "left out"})),
      remove_(new QPushButton) {
  remove_->setToolTip("Take the chosen sample out of use; it stays in the session database");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(remove_);
  layout->addWidget(table_);
  connect(table_, &QTableWidget::itemSelectionChanged, this, [this] { showChoice(); });
  connect(remove_, &QPushButton::clicked, this, [this, remove = std::move(remove)] {
    const int row = table_->currentRow();
    if (row >= 0 && row < static_cast<int>(lines_.size())) {
      remove(lines_[static_cast<std::size_t>(row)].id);
    }
  });
  showChoice();
}

void SampleTable::fill(std::vector<SampleLine> lines) {
  if (lines == lines_) {
    return;
  }
  const int chosen = table_->currentRow();
  const std::uint32_t id = chosen < 0 ? 0 : lines_[static_cast<std::size_t>(chosen)].id;
  lines_ = std::move(lines);
  table_->clearSelection();
  table_->setCurrentItem(nullptr);
  table_->setRowCount(static_cast<int>(lines_.size()));
  int row = 0;
  for (const SampleLine& line : lines_) {
    int column = 0;
    for (const std::string& text : {std::to_string(line.id),
                                    line.quantity,
                                    line.angles,
                                    line.residual,
                                    line.standardized,
                                    line.verdict}) {
      table_->setItem(row, column++, new QTableWidgetItem(QString::fromStdString(text)));
    }
    if (chosen >= 0 && line.id == id && table_->currentRow() < 0) {
      table_->selectRow(row);
    }
    ++row;
  }
  showChoice();
}

void SampleTable::showChoice() {
  const int row = table_->currentRow();
  const bool is_chosen = row >= 0 && row < static_cast<int>(lines_.size());
  remove_->setText(is_chosen
                       ? QString("Remove sample %1").arg(lines_[static_cast<std::size_t>(row)].id)
                       : QString("Remove sample: choose one below"));
}

}  // namespace sac
