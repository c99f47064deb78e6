#include "parameter_table.hpp"

#include <QHeaderView>
#include <string>

namespace sac {

ParameterTable::ParameterTable() : QTableWidget(0, 3) {
  setHorizontalHeaderLabels({"parameter", "value", "uncertainty"});
  horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  constexpr int kValue = 1;  // the widest: an axis
  horizontalHeader()->setSectionResizeMode(kValue, QHeaderView::Stretch);
  verticalHeader()->hide();
  verticalHeader()->setDefaultSectionSize(20);
  setEditTriggers(QAbstractItemView::NoEditTriggers);
}

void ParameterTable::fill(const std::vector<ParameterLine>& lines) {
  setRowCount(static_cast<int>(lines.size()));
  int row = 0;
  for (const ParameterLine& line : lines) {
    int column = 0;
    for (const std::string& text : {line.name, line.value, line.uncertainty}) {
      setItem(row, column++, new QTableWidgetItem(QString::fromStdString(text)));
    }
    ++row;
  }
}

}  // namespace sac
