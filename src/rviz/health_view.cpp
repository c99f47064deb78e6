#include "health_view.hpp"

#include <QGridLayout>
#include <string>

namespace sac {
namespace {

constexpr std::size_t kStreamCount = 4;

const char* colorOf(HealthLine::Level level) {
  switch (level) {
    case HealthLine::Level::kGood:
      return "#1b9e4b";
    case HealthLine::Level::kWarning:
      return "#d98200";
    case HealthLine::Level::kError:
      return "#c62828";
    case HealthLine::Level::kUnknown:
      break;
  }
  return "#9a9fa6";
}

QString dotted(const HealthLine& line) {
  return QString("<span style='color:%1'>●</span> %2")
      .arg(colorOf(line.level), QString::fromStdString(line.name).toHtmlEscaped());
}

}  // namespace

HealthView::HealthView() : trouble_(new QLabel) {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  for (std::size_t n = 0; n < kStreamCount; ++n) {
    streams_.push_back(new QLabel);
    grid->addWidget(streams_.back(), static_cast<int>(n / 2), static_cast<int>(n % 2));
  }
  trouble_->setWordWrap(true);
  trouble_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  grid->addWidget(trouble_, grid->rowCount(), 0, 1, 2);
}

void HealthView::fill(const std::vector<HealthLine>& streams,
                      const std::vector<HealthLine>& troubles) {
  // A rotor without joints has one stream fewer, as soon as that is known.
  for (std::size_t n = 0; n < streams_.size(); ++n) {
    const bool is_there = n < streams.size();
    streams_[n]->setText(is_there ? dotted(streams[n]) : QString());
    streams_[n]->setToolTip(is_there ? QString::fromStdString(streams[n].message) : QString());
  }
  trouble_->setVisible(!troubles.empty());
  if (!troubles.empty()) {
    trouble_->setText(dotted(troubles.front()) + ": " +
                      QString::fromStdString(troubles.front().message).toHtmlEscaped());
  }
}

}  // namespace sac
