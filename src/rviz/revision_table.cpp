#include "revision_table.hpp"

#include <QShowEvent>
#include <QVBoxLayout>
#include <utility>

#include "choice_table.hpp"
#include "spherical_actuator_calibration/ListRevisions.h"

namespace sac {

RevisionTable::RevisionTable(const ros::NodeHandle& node,
                             std::function<void(std::uint32_t)> restore)
    : node_(node),
      restore_(new QPushButton),
      note_(new QLabel),
      table_(choiceTable({"revision", "date (UTC)", "error", "drift", "made by"})) {
  restore_->setToolTip("Put the chosen revision of the parameters back in force, as a new one");
  note_->setWordWrap(true);
  note_->hide();
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(restore_);
  layout->addWidget(note_);
  layout->addWidget(table_);
  connect(table_, &QTableWidget::itemSelectionChanged, this, [this] { showChoice(); });
  connect(restore_, &QPushButton::clicked, this, [this, restore = std::move(restore)] {
    if (const auto number = chosen()) {
      restore(*number);
    }
  });
  showChoice();
}

void RevisionTable::refresh(const std::string& in_force, std::uint32_t number) {
  if (const std::optional<ServiceAnswer> answer = caller_.takeAnswer()) {
    const bool is_trouble = !answer->success || answer->is_partial;
    note_->setStyleSheet("color: #c62828;");
    showNote(is_trouble ? QString::fromStdString(answer->message) : QString());
    if (answer->success) {
      fill(revisionLines(answer->revisions, number));
    }
  }
  is_old_ = is_old_ || in_force != in_force_;
  in_force_ = in_force;
  if (is_old_ && isVisible() && !caller_.isBusy()) {
    is_old_ = false;
    note_->setStyleSheet("");
    showNote("Reading the sessions …");
    caller_.call<msg::ListRevisions>(node_.resolveName("calibration/list_revisions"),
                                     msg::ListRevisions::Request());
  }
}

void RevisionTable::showNote(const QString& text) {
  note_->setText(text);
  note_->setVisible(!text.isEmpty());
}

void RevisionTable::showEvent(QShowEvent* event) {
  is_old_ = true;
  table_->setFocus();
  QWidget::showEvent(event);
}

void RevisionTable::fill(std::vector<RevisionLine> lines) {
  if (lines == lines_) {
    return;
  }
  lines_ = std::move(lines);
  table_->clearSelection();
  table_->setCurrentItem(nullptr);
  table_->setRowCount(static_cast<int>(lines_.size()));
  int row = 0;
  for (const RevisionLine& line : lines_) {
    int column = 0;
    for (const std::string& text : {line.name, line.date, line.error, line.drift, line.origin}) {
      auto* item = new QTableWidgetItem(QString::fromStdString(text));
      item->setToolTip(item->text());
      table_->setItem(row, column++, item);
    }
    ++row;
  }
  showChoice();
}

std::optional<std::uint32_t> RevisionTable::chosen() const {
  const int row = table_->currentRow();
  if (row < 0 || row >= static_cast<int>(lines_.size())) {
    return std::nullopt;
  }
  const RevisionLine& line = lines_[static_cast<std::size_t>(row)];
  return line.restorable ? std::make_optional(line.number) : std::nullopt;
}

// A new text takes the shortcut away, so that the key is a part of it.
void RevisionTable::showChoice() {
  const auto number = chosen();
  restore_->setText(number ? QString("R&estore revision %1").arg(*number)
                    : table_->currentRow() < 0
                        ? QString("Restore revision: choose one below")
                        : QString("Restore revision: that one is of another session"));
}

}  // namespace sac
