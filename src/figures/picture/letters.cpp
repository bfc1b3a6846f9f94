// SPDX-License-Identifier: Apache-2.0
#include "figures/picture/letters.h"

#include <cmath>
#include <string_view>

namespace phalanx::picture {
namespace {

using Vec2f = Eigen::Vector2f;

class Pen {
 public:
  explicit Pen(Strokes& lines) : lines_(lines) {}
  void line(float x0, float y0, float x1, float y1) { lines_.emplace_back(Vec2f(x0, y0), Vec2f(x1, y1)); }
  /// Draws part of an ellipse between two angles [deg], counter-clockwise from +x.
  void arc(float cx, float cy, float rx, float ry, float from_deg, float to_deg) {
    constexpr int kParts = 14;
    const auto at = [&](int i) {
      const float a = (from_deg + (to_deg - from_deg) * static_cast<float>(i) / kParts) * 0.01745329252F;
      return Vec2f(cx + rx * std::cos(a), cy + ry * std::sin(a));
    };
    for (int i = 0; i < kParts; ++i) lines_.emplace_back(at(i), at(i + 1));
  }
  void bowl() { arc(1.7F, 2, 1.7F, 2, 0, 360); }
  /// Draws an arch from an upright stroke at x down to the base line.
  void arch(float x, float width) {
    arc(x + 0.5F * width, 2.4F, 0.5F * width, 1.6F, 180, 0);
    line(x + width, 2.4F, x + width, 0);
  }

 private:
  Strokes& lines_;
};

constexpr std::string_view kNarrow = "fijlrt";
constexpr std::string_view kWide = "mw";

}  // namespace

void letter_strokes(char letter, Strokes& lines) {
  Pen pen(lines);
  switch (letter) {
    case '0':
      pen.arc(2, 3, 2, 3, 0, 360);
      break;
    case '1':
      pen.line(2.2F, 0, 2.2F, 6);
      pen.line(2.2F, 6, 0.7F, 4.8F);
      break;
    case '2':
      pen.arc(2, 4.2F, 1.9F, 1.8F, 170, -35);
      pen.line(3.55F, 3.15F, 0.1F, 0);
      pen.line(0.1F, 0, 4, 0);
      break;
    case '3':
      pen.arc(1.9F, 4.5F, 1.6F, 1.5F, 150, -90);
      pen.arc(1.9F, 1.55F, 1.9F, 1.55F, 90, -155);
      break;
    case '4':
      pen.line(3, 0, 3, 6);
      pen.line(3, 6, 0, 1.7F);
      pen.line(0, 1.7F, 4.1F, 1.7F);
      break;
    case '5':
      pen.line(3.7F, 6, 0.7F, 6);
      pen.line(0.7F, 6, 0.4F, 3.3F);
      pen.arc(1.9F, 1.95F, 2, 1.95F, 133, -145);
      break;
    case '6':
      pen.arc(2, 1.95F, 1.95F, 1.95F, 0, 360);
      pen.arc(4.6F, 1.95F, 4.55F, 4.4F, 180, 113);
      break;
    case '7':
      pen.line(0, 6, 4, 6);
      pen.line(4, 6, 1.3F, 0);
      break;
    case '8':
      pen.arc(2, 4.55F, 1.55F, 1.45F, 0, 360);
      pen.arc(2, 1.55F, 1.9F, 1.55F, 0, 360);
      break;
    case '9':
      pen.arc(2, 4.05F, 1.95F, 1.95F, 0, 360);
      pen.arc(-0.6F, 4.05F, 4.55F, 4.4F, 0, -67);
      break;
    case 'N':
      pen.line(0, 0, 0, 6);
      pen.line(0, 6, 4, 0);
      pen.line(4, 0, 4, 6);
      break;
    case 'a':
      pen.bowl();
      pen.line(3.4F, 4, 3.4F, 0);
      break;
    case 'b':
      pen.bowl();
      pen.line(0, 6, 0, 0);
      break;
    case 'c':
      pen.arc(1.8F, 2, 1.8F, 2, 48, 312);
      break;
    case 'd':
      pen.bowl();
      pen.line(3.4F, 6, 3.4F, 0);
      break;
    case 'e':
      pen.line(0, 2.1F, 3.5F, 2.1F);
      pen.arc(1.75F, 2, 1.75F, 2, 3, 315);
      break;
    case 'f':
      pen.arc(2.1F, 4.9F, 1, 1.1F, 60, 180);
      pen.line(1.1F, 4.9F, 1.1F, 0);
      pen.line(0.2F, 4, 2.3F, 4);
      break;
    case 'g':
      pen.bowl();
      pen.line(3.4F, 4, 3.4F, -0.3F);
      pen.arc(1.8F, -0.3F, 1.6F, 1.7F, 0, -145);
      break;
    case 'h':
      pen.line(0, 6, 0, 0);
      pen.arch(0, 3.2F);
      break;
    case 'i':
      pen.line(1, 4, 1, 0);
      pen.line(1, 5.6F, 1, 5.7F);
      break;
    case 'j':
      pen.line(1.4F, 4, 1.4F, -0.7F);
      pen.arc(0.4F, -0.7F, 1, 1.2F, 0, -100);
      pen.line(1.4F, 5.6F, 1.4F, 5.7F);
      break;
    case 'k':
      pen.line(0, 6, 0, 0);
      pen.line(2.9F, 4, 0, 1.5F);
      pen.line(1.1F, 2.5F, 3.1F, 0);
      break;
    case 'l':
      pen.line(1, 6, 1, 0);
      break;
    case 'm':
      pen.line(0, 4, 0, 0);
      pen.arch(0, 2.6F);
      pen.arch(2.6F, 2.6F);
      break;
    case 'n':
      pen.line(0, 4, 0, 0);
      pen.arch(0, 3.2F);
      break;
    case 'o':
      pen.bowl();
      break;
    case 'p':
      pen.bowl();
      pen.line(0, 4, 0, -2);
      break;
    case 'q':
      pen.bowl();
      pen.line(3.4F, 4, 3.4F, -2);
      break;
    case 'r':
      pen.line(0.3F, 4, 0.3F, 0);
      pen.arc(1.7F, 2.4F, 1.4F, 1.6F, 180, 65);
      break;
    case 's':
      pen.arc(1.6F, 3, 1.3F, 1, 35, 270);
      pen.arc(1.6F, 1, 1.4F, 1, 90, -150);
      break;
    case 't':
      pen.line(1, 5.4F, 1, 1);
      pen.arc(2, 1, 1, 1, 180, 290);
      pen.line(0.1F, 4, 2.3F, 4);
      break;
    case 'u':
      pen.line(0, 4, 0, 1.6F);
      pen.arc(1.6F, 1.6F, 1.6F, 1.6F, 180, 360);
      pen.line(3.2F, 4, 3.2F, 0);
      break;
    case 'v':
      pen.line(0, 4, 1.7F, 0);
      pen.line(1.7F, 0, 3.4F, 4);
      break;
    case 'w':
      pen.line(0, 4, 1.3F, 0);
      pen.line(1.3F, 0, 2.6F, 4);
      pen.line(2.6F, 4, 3.9F, 0);
      pen.line(3.9F, 0, 5.2F, 4);
      break;
    case 'x':
      pen.line(0, 4, 3.2F, 0);
      pen.line(0, 0, 3.2F, 4);
      break;
    case 'y':
      pen.line(0, 4, 1.7F, 0);
      pen.line(3.4F, 4, 0.9F, -2);
      break;
    case 'z':
      pen.line(0.1F, 4, 3.2F, 4);
      pen.line(3.2F, 4, 0, 0);
      pen.line(0, 0, 3.3F, 0);
      break;
    case '_':
      pen.line(0, -0.7F, 3.4F, -0.7F);
      break;
    case '.':
      pen.line(0.6F, 0.1F, 0.6F, 0.15F);
      break;
    default:
      break;
  }
}

float letter_advance(char letter) {
  if (letter == '_') return 4.6F;
  if (letter == '.') return 2.2F;
  if (letter == ' ') return 2.6F;
  if (letter < 'a' || letter > 'z') return 5.6F;
  if (kNarrow.find(letter) != std::string_view::npos) return letter == 'r' || letter == 't' ? 3.6F : 3.1F;
  return kWide.find(letter) != std::string_view::npos ? 6.7F : 4.9F;
}

}  // namespace phalanx::picture
