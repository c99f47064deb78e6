#pragma once

#include <QLabel>
#include <QPushButton>
#include <QTableWidget>
#include <QWidget>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "revision_lines.hpp"
#include "service_caller.hpp"

namespace sac {

/// The revisions of the unit by date, of which one can be put back in force.
class RevisionTable : public QWidget {
 public:
  /// `restore` is called with the revision that the operator has chosen.
  RevisionTable(const ros::NodeHandle& node, std::function<void(std::uint32_t)> restore);

  /// To be called ten times a second with the revision in force, in words and its number; where it
  /// is another one, the engine is asked for the list.
  void refresh(const std::string& in_force, std::uint32_t number);
  QPushButton* restoreButton() const { return restore_; }

 protected:
  /// Asks anew, too; arrow keys choose.
  void showEvent(QShowEvent* event) override;

 private:
  void fill(std::vector<RevisionLine> lines);
  /// Above the list, which stays; empty: nothing.
  void showNote(const QString& text);
  void showChoice();
  std::optional<std::uint32_t> chosen() const;

  ros::NodeHandle node_;
  ServiceCaller caller_;
  std::string in_force_;
  bool is_old_ = false;
  std::vector<RevisionLine> lines_;
  QPushButton* restore_;
  QLabel* note_;
  QTableWidget* table_;
};

}  // namespace sac
