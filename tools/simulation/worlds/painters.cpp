#include "simulation/worlds/painters.h"

#include <cmath>
#include <numbers>

#include "simulation/rendering/scene.h"
#include "simulation/worlds/smooth_step.h"
#include "util/hash.h"

namespace ldso::simulation {
namespace {

float tone(std::uint64_t seed, std::uint64_t a, std::uint64_t b) { return unit_interval_float(hash_of(seed, a, b)); }

/// 1 inside of a cell, falling to 0 at its joint.
double joint_profile(double distance, double half_joint, double softness) {
  return smooth_step(half_joint - softness, half_joint + softness, distance);
}

void framed_glass(Canvas& canvas, double x0, double y0, double x1, double y1, float frame, Random& random) {
  const double w = x1 - x0, h = y1 - y0, bar = std::max(0.05, 0.06 * w);
  canvas.rectangle(x0, y0, x1, y1, frame);
  const int panes_x = w > 0.9 ? 2 : 1, panes_y = random.chance(0.4) ? 2 : 1;
  const auto top_tone = static_cast<float>(random.uniform(0.05, 0.3)),
             low_tone = static_cast<float>(random.uniform(0.03, 0.2));
  for (int j = 0; j < panes_y; ++j) {
    for (int i = 0; i < panes_x; ++i) {
      const double px0 = x0 + bar + i * (w - bar) / panes_x, px1 = x0 + (i + 1) * (w - bar) / panes_x;
      const double py0 = y0 + bar + j * (h - bar) / panes_y, py1 = y0 + (j + 1) * (h - bar) / panes_y;
      canvas.rectangle(px0, py0, px1, py1, 0.1f);
      canvas.apply(px0, py0, px1, py1, [&](double, double y, float) {
        return top_tone + (low_tone - top_tone) * static_cast<float>((y - y0) / h);
      });
    }
  }
  const double inner_w = w - 2 * bar;
  if (random.chance(0.45)) {  // A curtain at one side or both.
    const auto cloth = static_cast<float>(random.uniform(0.35, 0.75));
    const double part = random.uniform(0.15, 0.4) * inner_w;
    canvas.rectangle(x0 + bar, y0 + bar, x0 + bar + part, y1 - bar, cloth, 0.8f);
    if (random.chance(0.7)) canvas.rectangle(x1 - bar - part, y0 + bar, x1 - bar, y1 - bar, cloth, 0.8f);
  } else if (random.chance(0.35)) {  // A blind, partly down.
    const double down = y0 + bar + random.uniform(0.15, 0.7) * (h - 2 * bar);
    for (double y = y0 + bar; y < down; y += 0.08) canvas.rectangle(x0 + bar, y, x1 - bar, y + 0.06, 0.6f, 0.9f);
  }
  canvas.stain(x0, y0, x1, y1, noise_tiles().cloudy, 0.8, 0.12, random.bits());
}

void shutters(Canvas& canvas, double x0, double y0, double x1, double y1, float albedo) {
  canvas.rectangle(x0, y0, x1, y1, albedo);
  for (double y = y0 + 0.06; y < y1 - 0.05; y += 0.09)
    canvas.rectangle(x0 + 0.05, y, x1 - 0.05, y + 0.035, 0.6f * albedo);
}

void shop_front(Canvas& canvas, double top, double bottom, Random& random) {
  const double width = canvas.width();
  const auto sign = static_cast<float>(random.uniform(0.1, 0.85));
  canvas.rectangle(0.2, top + 0.25, width - 0.2, top + 0.85, sign);
  canvas.writing(width * random.uniform(0.08, 0.3), top + 0.36, width * random.uniform(0.6, 0.95), top + 0.75, 0.38,
                 sign > 0.45f ? 0.08f : 0.9f, random.bits());
  double x = 0.4;
  while (x < width - 1.5) {
    const double w = std::min(random.uniform(1.2, 2.6), width - 0.4 - x);
    framed_glass(canvas, x, top + 1.0, x + w, bottom - 0.35, static_cast<float>(random.uniform(0.15, 0.7)), random);
    for (int i = 0; i < 6; ++i) {  // Goods.
      const double gx = random.uniform(x + 0.1, x + w - 0.35), gy = random.uniform(top + 1.2, bottom - 0.9);
      canvas.rectangle(gx, gy, gx + random.uniform(0.1, 0.35), gy + random.uniform(0.1, 0.45),
                       static_cast<float>(random.uniform(0.05, 0.9)), 0.8f);
    }
    x += w + random.uniform(0.15, 0.5);
  }
}

void wall_coat(Canvas& canvas, std::uint64_t seed, bool front) {
  Random random(seed, 1);
  const int kind = random.index(5);
  const auto albedo = static_cast<float>(random.uniform(0.28, 0.72));
  if (kind <= 1) {
    paint_bricks(canvas, random.uniform(0.22, 0.27), random.uniform(0.07, 0.09), 0.75f * albedo,
                 static_cast<float>(random.uniform(0.35, 0.65)), seed);
  } else if (kind == 2) {
    paint_bricks(canvas, random.uniform(0.5, 0.9), random.uniform(0.25, 0.4), albedo, 0.7f * albedo, seed);
  } else if (kind == 3 && front) {
    paint_planks(canvas, random.uniform(0.14, 0.24), albedo, seed);
  } else {
    paint_plaster(canvas, albedo, seed);
  }
}

/// Streaks under sills, darker foot, a few patches where the coat was repaired.
void weather(Canvas& canvas, Random& random) {
  const double w = canvas.width(), h = canvas.height();
  for (int i = 0; i < 5; ++i) {
    const double x = random.uniform(0, w), y = random.uniform(0, h), side = random.uniform(0.2, 1.2);
    canvas.rectangle(x, y, x + side, y + random.uniform(0.2, 0.9), static_cast<float>(random.uniform(0.2, 0.7)), 0.15f);
  }
  const PlacedNoise streaks(noise_tiles().natural, 0.5, random.bits());
  canvas.apply([&](double x, double y, float old) {
    const double foot = smooth_step(0.9, 0.0, h - y) * 0.25;
    return old * (1 - foot) * (1 + 0.07 * streaks.at(x, 0.15 * y));
  });
}

void landscape(Canvas& canvas, double x0, double y0, double x1, double y1, Random& random) {
  const PlacedNoise ridge(noise_tiles().natural, 0.3 * (x1 - x0), random.bits()),
      far_ridge(noise_tiles().cloudy, 0.4 * (x1 - x0), random.bits()),
      texture(noise_tiles().natural, 0.12 * (x1 - x0), random.bits());
  const double horizon = y0 + random.uniform(0.35, 0.6) * (y1 - y0), scale = 0.12 * (y1 - y0);
  canvas.apply(x0, y0, x1, y1, [&](double x, double y, float) {
    const double n = texture.at(x, y);
    if (y > horizon + 1.2 * scale + scale * ridge.at(x, 0)) return 0.28 + 0.13 * n;
    if (y > horizon + scale * far_ridge.at(x, 0.5)) return 0.45 + 0.05 * n;
    return 0.8 - 0.25 * (y - y0) / (y1 - y0) + 0.04 * n;
  });
}

void blocks(Canvas& canvas, double x0, double y0, double x1, double y1, Random& random) {
  canvas.rectangle(x0, y0, x1, y1, static_cast<float>(random.uniform(0.3, 0.9)));
  for (int i = 0; i < 14; ++i) {
    const double cx = random.uniform(x0, x1), cy = random.uniform(y0, y1), size = random.uniform(0.06, 0.3) * (x1 - x0);
    const auto value = static_cast<float>(random.uniform(0.05, 0.9));
    const double l = std::max(x0, cx - size), r = std::min(x1, cx + size), t = std::max(y0, cy - 0.6 * size),
                 b = std::min(y1, cy + 0.6 * size);
    if (random.chance(0.5)) {
      canvas.rectangle(l, t, r, b, value);
    } else {
      const double radius = std::min({0.7 * size, cx - x0, x1 - cx, cy - y0, y1 - cy});
      if (radius > 0) canvas.disc(cx, cy, radius, value);
    }
  }
}

void portrait(Canvas& canvas, double x0, double y0, double x1, double y1, Random& random) {
  const double w = x1 - x0, h = y1 - y0, cx = x0 + w * random.uniform(0.4, 0.6), cy = y0 + 0.38 * h;
  canvas.rectangle(x0, y0, x1, y1, static_cast<float>(random.uniform(0.15, 0.75)));
  canvas.stain(x0, y0, x1, y1, noise_tiles().cloudy, 0.3 * w, 0.25, random.bits());
  const double head = 0.2 * std::min(w, h);
  canvas.rectangle(cx - 1.6 * head, cy + 1.3 * head, cx + 1.6 * head, y1,
                   static_cast<float>(random.uniform(0.05, 0.8)));
  canvas.disc(cx, cy - 0.3 * head, 1.15 * head, static_cast<float>(random.uniform(0.05, 0.4)));
  canvas.disc(cx, cy, head, static_cast<float>(random.uniform(0.5, 0.8)));
  canvas.disc(cx - 0.35 * head, cy - 0.1 * head, 0.12 * head, 0.1f);
  canvas.disc(cx + 0.35 * head, cy - 0.1 * head, 0.12 * head, 0.1f);
  canvas.rectangle(cx - 0.3 * head, cy + 0.45 * head, cx + 0.3 * head, cy + 0.55 * head, 0.25f);
}

void text_page(Canvas& canvas, double x0, double y0, double x1, double y1, Random& random) {
  const bool dark = random.chance(0.3);
  canvas.rectangle(x0, y0, x1, y1, dark ? 0.15f : 0.88f);
  const double w = x1 - x0, h = y1 - y0;
  canvas.writing(x0 + 0.08 * w, y0 + 0.07 * h, x1 - 0.1 * w, y0 + 0.2 * h, 0.11 * h, dark ? 0.9f : 0.08f,
                 random.bits());
  canvas.rectangle(x0 + 0.1 * w, y0 + 0.28 * h, x0 + random.uniform(0.4, 0.9) * w, y0 + 0.6 * h,
                   static_cast<float>(random.uniform(0.2, 0.7)));
  canvas.writing(x0 + 0.08 * w, y0 + 0.66 * h, x1 - 0.08 * w, y1 - 0.06 * h, 0.045 * h, dark ? 0.8f : 0.15f,
                 random.bits());
}

}  // namespace

void paint_plaster(Canvas& canvas, float albedo, std::uint64_t seed) {
  const PlacedNoise wide(noise_tiles().cloudy, 1.2, hash_of(seed, 1)),
      fine(noise_tiles().natural, 0.12, hash_of(seed, 2)), middle(noise_tiles().natural, 0.5, hash_of(seed, 3));
  canvas.apply([&](double x, double y, float) {
    return albedo * (1 + 0.07 * wide.at(x, y) + 0.06 * fine.at(x, y) + 0.05 * middle.at(x, y));
  });
}

void paint_bricks(Canvas& canvas, double length, double height, float albedo, float joint, std::uint64_t seed) {
  const PlacedNoise wide(noise_tiles().cloudy, 1.5, hash_of(seed, 1)),
      fine(noise_tiles().natural, 0.15, hash_of(seed, 2));
  const double half_joint = std::max(0.004, 0.06 * height), softness = std::max(canvas.step_x() * 0.6, 0.003);
  canvas.apply([&](double x, double y, float) {
    const double course = std::floor(y / height);
    const double shifted =
        x / length + 0.5 * std::fmod(course, 2.0) + 0.1 * tone(seed, static_cast<std::uint64_t>(course), 7);
    const double stone = std::floor(shifted);
    const double in_x = (shifted - stone) * length, in_y = y - course * height;
    const double distance = std::min(std::min(in_x, length - in_x), std::min(in_y, height - in_y));
    const double body = joint_profile(distance, half_joint, softness);
    const double own =
        0.7 + 0.6 * tone(seed, static_cast<std::uint64_t>(course + 1), static_cast<std::uint64_t>(stone + 16));
    const double stone_albedo = albedo * own * (1 + 0.1 * fine.at(x, y));
    return (joint + body * (stone_albedo - joint)) * (1 + 0.08 * wide.at(x, y));
  });
}

void paint_planks(Canvas& canvas, double board, float albedo, std::uint64_t seed) {
  const PlacedNoise wide(noise_tiles().cloudy, 1.0, hash_of(seed, 1));
  Random random(seed, 5);
  const double off_x = random.uniform(0, 500), off_y = random.uniform(0, 500);
  canvas.apply([&](double x, double y, float) {
    const double row = std::floor(y / board);
    const double start = 3.0 * tone(seed, static_cast<std::uint64_t>(row), 3), piece = std::floor((x + start) / 2.1);
    const double in_x = (x + start) - piece * 2.1, in_y = y - row * board;
    const double own = tone(seed, static_cast<std::uint64_t>(row), static_cast<std::uint64_t>(piece) + 8);
    const double grain = noise_tiles().natural.at(off_x + 40 * x + 900 * own, off_y + 700 * y + 300 * own);
    const double distance = std::min(std::min(in_y, board - in_y), std::min(in_x, 2.1 - in_x));
    const double body = joint_profile(distance, 0.004, std::max(0.003, 0.7 * canvas.step_y()));
    return albedo * (0.75 + 0.5 * own) * (1 + 0.13 * grain) * (0.4 + 0.6 * body) * (1 + 0.05 * wide.at(x, y));
  });
}

void paint_tiles(Canvas& canvas, double side, float albedo, float contrast, std::uint64_t seed) {
  const PlacedNoise wide(noise_tiles().cloudy, 1.6, hash_of(seed, 1)),
      marble(noise_tiles().natural, 0.35, hash_of(seed, 2));
  canvas.apply([&](double x, double y, float) {
    const double i = std::floor(x / side), j = std::floor(y / side);
    const double in_x = x - i * side, in_y = y - j * side;
    const double distance = std::min(std::min(in_x, side - in_x), std::min(in_y, side - in_y));
    const double body = joint_profile(distance, 0.004, std::max(0.003, 0.7 * canvas.step_x()));
    const double own = tone(seed, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j)) - 0.5;
    const double shift = 5 * own;
    const double value = albedo * (1 + contrast * own + 0.12 * marble.at(x + shift, y - shift));
    return (0.5 * albedo + body * (value - 0.5 * albedo)) * (1 + 0.06 * wide.at(x, y));
  });
}

void paint_metal(Canvas& canvas, float albedo, std::uint64_t seed) {
  canvas.fill(albedo);
  canvas.stain(noise_tiles().cloudy, 0.6, 0.06, hash_of(seed, 1));
  canvas.stain(noise_tiles().natural, 0.1, 0.05, hash_of(seed, 2));
}

void paint_facade(Canvas& canvas, int storeys, bool front, std::uint64_t seed) {
  Random random(seed, 2);
  wall_coat(canvas, seed, front);
  weather(canvas, random);
  const double w = canvas.width(), h = canvas.height(), storey = h / storeys;
  const auto frame = static_cast<float>(random.uniform(0.3, 0.9)),
             trim = static_cast<float>(random.uniform(0.25, 0.85));
  const bool has_shutters = front && random.chance(0.3), has_trim = random.chance(0.6);
  const bool shop = front && storeys > 1 && random.chance(0.25);
  const double window_w = random.uniform(0.8, 1.4), window_h = random.uniform(1.1, 1.6);
  const int columns = std::max(1, static_cast<int>(w / (window_w + random.uniform(1.0, 2.2))));
  const int door_column = random.index(columns);
  if (has_trim) {
    for (int level = 1; level < storeys; ++level)
      canvas.rectangle(0, level * storey - 0.12, w, level * storey + 0.08, trim, 0.9f);
  }
  for (int level = 0; level < storeys; ++level) {
    const bool ground = level == storeys - 1;
    if (ground && shop) {
      shop_front(canvas, level * storey, h, random);
      break;
    }
    for (int column = 0; column < columns; ++column) {
      const double centre = w * (column + 0.5) / columns + random.uniform(-0.1, 0.1);
      const double top = level * storey + 0.55 + random.uniform(-0.05, 0.05);
      if (ground && front && column == door_column) {
        paint_door(canvas, centre - 0.55, h - 2.25, centre + 0.55, h - 0.1, random.bits());
        canvas.rectangle(centre - 0.75, h - 0.12, centre + 0.75, h, 0.45f);
        continue;
      }
      if (random.chance(front ? 0.08 : 0.5)) continue;
      const double x0 = centre - 0.5 * window_w, x1 = centre + 0.5 * window_w,
                   y1 = top + std::min(window_h, storey - 0.9);
      if (has_trim) canvas.rectangle(x0 - 0.12, top - 0.12, x1 + 0.12, y1 + 0.08, trim);
      framed_glass(canvas, x0, top, x1, y1, frame, random);
      canvas.rectangle(x0 - 0.1, y1, x1 + 0.1, y1 + 0.07, 0.8f * trim);
      canvas.rectangle(x0 - 0.05, y1 + 0.07, x1 + 0.05, y1 + 0.16, 0.15f, 0.35f);  // Shadow of the sill.
      if (has_shutters) {
        shutters(canvas, x0 - 0.5 * window_w - 0.06, top, x0 - 0.06, y1, 0.7f * trim);
        shutters(canvas, x1 + 0.06, top, x1 + 0.5 * window_w + 0.06, y1, 0.7f * trim);
      }
    }
  }
  if (front && random.chance(0.5)) canvas.rectangle(w - 0.3, 0, w - 0.2, h, 0.3f, 0.8f);  // Down-pipe.
}

void paint_roof(Canvas& canvas, std::uint64_t seed) {
  Random random(seed, 3);
  paint_bricks(canvas, random.uniform(0.22, 0.3), random.uniform(0.28, 0.36),
               static_cast<float>(random.uniform(0.15, 0.4)), 0.08f, seed);
  canvas.stain(noise_tiles().natural, 1.0, 0.12, seed);
}

void paint_car_side(Canvas& canvas, std::uint64_t seed) {
  Random random(seed, 4);
  const double w = canvas.width(), h = canvas.height();
  const auto body = static_cast<float>(random.uniform(0.06, 0.8));
  canvas.fill(body);
  canvas.apply([&](double, double y, float old) { return old * (1.12 - 0.35 * y / h); });
  canvas.line(0.05 * w, 0.45 * h, 0.95 * w, 0.47 * h, 0.03, 0.6f * body);
  canvas.line(0.5 * w, 0.05 * h, 0.5 * w, 0.75 * h, 0.02, 0.4f * body);
  canvas.rectangle(0.42 * w, 0.25 * h, 0.47 * w, 0.28 * h, 0.75f);
  canvas.rectangle(0, 0.82 * h, w, h, 0.05f, 0.7f);
  for (const double x : {0.2 * w, 0.8 * w}) {
    canvas.disc(x, 0.72 * h, 0.3 * h, 0.04f);
    canvas.disc(x, 0.74 * h, 0.17 * h, static_cast<float>(random.uniform(0.35, 0.7)));
    canvas.disc(x, 0.74 * h, 0.05 * h, 0.1f);
  }
  canvas.stain(noise_tiles().natural, 0.4, 0.06, seed);
}

void paint_car_end(Canvas& canvas, std::uint64_t seed) {
  Random random(seed, 4);
  const double w = canvas.width(), h = canvas.height();
  const auto body = static_cast<float>(random.uniform(0.06, 0.8));
  canvas.fill(body);
  canvas.rectangle(0.03 * w, 0.2 * h, 0.2 * w, 0.42 * h, 0.85f);
  canvas.rectangle(0.8 * w, 0.2 * h, 0.97 * w, 0.42 * h, 0.85f);
  canvas.rectangle(0.25 * w, 0.2 * h, 0.75 * w, 0.4 * h, 0.08f);
  canvas.rectangle(0.35 * w, 0.55 * h, 0.65 * w, 0.7 * h, 0.85f);
  canvas.writing(0.38 * w, 0.575 * h, 0.63 * w, 0.68 * h, 0.1 * h, 0.06f, random.bits());
  canvas.rectangle(0, 0.78 * h, w, h, 0.06f, 0.8f);
  canvas.stain(noise_tiles().natural, 0.4, 0.06, seed);
}

void paint_picture(Canvas& canvas, double x0, double y0, double x1, double y1, std::uint64_t seed) {
  Random random(seed, 6);
  const int kind = random.index(4);
  if (kind == 0) landscape(canvas, x0, y0, x1, y1, random);
  if (kind == 1) blocks(canvas, x0, y0, x1, y1, random);
  if (kind == 2) portrait(canvas, x0, y0, x1, y1, random);
  if (kind == 3) text_page(canvas, x0, y0, x1, y1, random);
  canvas.stain(x0, y0, x1, y1, noise_tiles().natural, 0.25 * (x1 - x0), 0.1, random.bits());
  if (random.chance(0.6)) {  // A frame.
    const auto frame = static_cast<float>(random.uniform(0.08, 0.7));
    const double bar = 0.03 * std::max(x1 - x0, y1 - y0) + 0.01;
    canvas.rectangle(x0, y0, x1, y0 + bar, frame);
    canvas.rectangle(x0, y1 - bar, x1, y1, 0.8f * frame);
    canvas.rectangle(x0, y0, x0 + bar, y1, frame);
    canvas.rectangle(x1 - bar, y0, x1, y1, 0.8f * frame);
  }
}

void paint_door(Canvas& canvas, double x0, double y0, double x1, double y1, std::uint64_t seed) {
  Random random(seed, 7);
  const double w = x1 - x0, h = y1 - y0;
  const auto wood = static_cast<float>(random.uniform(0.15, 0.65));
  canvas.rectangle(x0 - 0.08, y0 - 0.08, x1 + 0.08, y1, static_cast<float>(random.uniform(0.25, 0.85)));
  canvas.rectangle(x0, y0, x1, y1, wood);
  const bool glass = random.chance(0.4);
  const int rows = 2 + random.index(3), columns = 1 + random.index(2);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const double px0 = x0 + w * (0.1 + 0.84 * i / columns), px1 = x0 + w * (0.06 + 0.84 * (i + 1) / columns);
      const double py0 = y0 + h * (0.06 + 0.9 * j / rows), py1 = y0 + h * (0.02 + 0.9 * (j + 1) / rows);
      canvas.rectangle(px0, py0, px1, py1, glass && j == 0 ? 0.12f : 0.7f * wood);
      canvas.rectangle(px0 + 0.03, py0 + 0.03, px1 - 0.02, py1 - 0.02, glass && j == 0 ? 0.2f : 0.95f * wood);
    }
  }
  canvas.stain(x0, y0, x1, y1, noise_tiles().natural, 0.3, 0.1, random.bits());
  canvas.rectangle(x1 - 0.14 * w, y0 + 0.48 * h, x1 - 0.05 * w, y0 + 0.5 * h, 0.85f);
  if (random.chance(0.6)) {  // A plate with a number or name.
    canvas.rectangle(x0 + 0.3 * w, y0 + 0.2 * h, x0 + 0.7 * w, y0 + 0.29 * h, 0.85f);
    canvas.writing(x0 + 0.34 * w, y0 + 0.215 * h, x0 + 0.68 * w, y0 + 0.28 * h, 0.055 * h, 0.1f, random.bits());
  }
}

void paint_books(Canvas& canvas, double x0, double y0, double x1, double y1, std::uint64_t seed) {
  Random random(seed, 8);
  canvas.rectangle(x0, y0, x1, y1, 0.05f);
  double x = x0 + 0.01;
  while (x < x1 - 0.03) {
    if (random.chance(0.06)) {  // A gap.
      x += random.uniform(0.03, 0.12);
      continue;
    }
    const double wide = std::min(random.uniform(0.016, 0.055), x1 - x),
                 top = y0 + random.uniform(0.03, 0.35) * (y1 - y0);
    const auto cover = static_cast<float>(random.uniform(0.08, 0.85));
    canvas.rectangle(x, top, x + wide, y1, cover);
    const float mark = cover > 0.45f ? 0.5f * cover : std::min(1.0f, cover + 0.45f);
    const double tall = y1 - top;
    canvas.rectangle(x, top + 0.12 * tall, x + wide, top + 0.15 * tall, mark);
    canvas.rectangle(x + 0.3 * wide, top + random.uniform(0.2, 0.3) * tall, x + 0.7 * wide,
                     top + random.uniform(0.5, 0.8) * tall, mark);
    canvas.rectangle(x + wide - 0.003, top, x + wide, y1, 0.3f * cover);
    x += wide;
  }
  canvas.stain(x0, y0, x1, y1, noise_tiles().natural, 0.1, 0.08, random.bits());
}

void paint_carpet(Canvas& canvas, std::uint64_t seed) {
  Random random(seed, 9);
  const double w = canvas.width(), h = canvas.height(), border = 0.12 * std::min(w, h);
  const auto ground = static_cast<float>(random.uniform(0.25, 0.5)),
             pattern = static_cast<float>(random.uniform(0.5, 0.8));
  const PlacedNoise warp(noise_tiles().cloudy, 0.5, random.bits()), pile(noise_tiles().natural, 0.06, random.bits());
  const double pitch = random.uniform(0.22, 0.35);
  canvas.fill(0.6f * ground);
  canvas.rectangle(0.4 * border, 0.4 * border, w - 0.4 * border, h - 0.4 * border, pattern);
  canvas.rectangle(border, border, w - border, h - border, ground);
  canvas.apply(border, border, w - border, h - border, [&](double x, double y, float old) {
    const double n = warp.at(x, y), a = (x + 0.03 * n) / pitch, b = (y + 0.03 * n) / pitch;
    const double wave = std::sin(2 * std::numbers::pi * a) * std::sin(2 * std::numbers::pi * b);
    const double own = tone(seed, static_cast<std::uint64_t>(std::floor(2 * a) + 64),
                            static_cast<std::uint64_t>(std::floor(2 * b) + 64));
    return old + (pattern - old) * smooth_step(0.25, 0.45, std::abs(wave)) * (0.3 + 0.7 * own);
  });
  canvas.apply([&](double x, double y, float old) { return old * (1 + 0.1 * pile.at(x, y)); });
  canvas.stain(noise_tiles().cloudy, 0.6, 0.08, random.bits());
}

void paint_window(Canvas& canvas, double x0, double y0, double x1, double y1, std::uint64_t seed) {
  Random random(seed, 10);
  landscape(canvas, x0, y0, x1, y1, random);
  canvas.apply(x0, y0, x1, y1, [](double, double, float old) { return 0.35 + 0.7 * old; });
  const double bar = 0.05;
  for (const double x : {x0, 0.5 * (x0 + x1) - 0.5 * bar, x1 - bar}) canvas.rectangle(x, y0, x + bar, y1, 0.78f);
  for (const double y : {y0, y0 + 0.3 * (y1 - y0), y1 - bar}) canvas.rectangle(x0, y, x1, y + bar, 0.74f);
}

void paint_wallpaper(Canvas& canvas, float albedo, std::uint64_t seed) {
  Random random(seed, 11);
  const double pitch = random.uniform(0.12, 0.25);
  const PlacedNoise wide(noise_tiles().cloudy, 1.0, random.bits()), fine(noise_tiles().natural, 0.1, random.bits()),
      middle(noise_tiles().natural, 0.4, random.bits());
  canvas.apply([&](double x, double y, float) {
    const double i = std::floor(x / pitch), j = std::floor(y / pitch);
    const double cx =
        (i + 0.3 + 0.4 * tone(seed, static_cast<std::uint64_t>(i + 8), static_cast<std::uint64_t>(j + 8))) * pitch;
    const double cy =
        (j + 0.3 + 0.4 * tone(seed, static_cast<std::uint64_t>(j + 8), static_cast<std::uint64_t>(i + 99))) * pitch;
    const double radius =
        0.22 * pitch * (0.5 + tone(seed, static_cast<std::uint64_t>(i + 5), static_cast<std::uint64_t>(j + 77)));
    const double blossom = smooth_step(radius + 0.004, radius - 0.004, std::hypot(x - cx, y - cy));
    return albedo * (1 - 0.22 * blossom) * (1 + 0.07 * wide.at(x, y) + 0.05 * fine.at(x, y) + 0.05 * middle.at(x, y));
  });
}

Texture make_sky(std::uint64_t seed) {
  constexpr int kWidth = 2048, kHeight = 1024;
  Image<float> image(kWidth, kHeight);
  const PlacedNoise hills(noise_tiles().cloudy, 0.5, hash_of(seed, 3)),
      trees(noise_tiles().natural, 0.05, hash_of(seed, 4));
  const PlacedNoise clouds(noise_tiles().cloudy, 0.45, hash_of(seed, 1)),
      wisps(noise_tiles().cloudy, 0.16, hash_of(seed, 2));
  for (int row = 0; row < kHeight; ++row) {
    const double elevation = (0.5 - (row + 0.5) / kHeight) * std::numbers::pi;
    for (int column = 0; column < kWidth; ++column) {
      const double turn = 2 * std::numbers::pi * (column + 0.5) / kWidth;
      // Seen on a plane overhead that bends down at the horizon, which makes the turn seamless.
      const double reach = std::cos(elevation) / (0.35 + std::max(0.0, std::sin(elevation)));
      const double x = reach * std::sin(turn), y = reach * std::cos(turn);
      const double cover = smooth_step(-0.5, 1.3, clouds.at(x, y) + 0.35 * wisps.at(x, y));
      const double clear = 0.72 - 0.22 * std::max(0.0, std::sin(elevation));
      double value = clear + (0.97 - clear) * 0.8 * cover;
      const double skyline = 0.035 + 0.018 * hills.at(std::sin(turn), std::cos(turn));
      const double tree = trees.at(std::sin(turn), std::cos(turn) + elevation);
      value += (0.42 + 0.05 * tree - value) * smooth_step(0.004, -0.004, elevation - skyline - 0.003 * tree);
      image(column, row) = static_cast<float>(value);
    }
  }
  return Texture(image, TextureWrap::kRepeat);
}

Texture make_detail(std::uint64_t seed) {
  constexpr int kSize = NoiseTile::kSize;
  const NoiseTile tile(seed, kSize / 64, 5, 0.9), speckle(hash_of(seed, 2), kSize / 8, 2, 1.0);
  Image<float> image(kSize, kSize);
  double sum = 0;
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const float value = 0.15f * tile.at(column, row) + 0.06f * speckle.at(column, row);
      image(column, row) = std::clamp(value, -0.45f, 0.45f);
      sum += image(column, row);
    }
  }
  const auto mean = static_cast<float>(sum / static_cast<double>(image.size()));
  for (std::size_t i = 0; i < image.size(); ++i) image.data()[i] += Scene::kDetailMean - mean;
  return Texture(image, TextureWrap::kRepeat);
}

Texture make_foliage(std::uint64_t seed) {
  constexpr int kSize = NoiseTile::kSize;
  const NoiseTile mass(hash_of(seed, 1), 8, 4, 0.8), leaves(hash_of(seed, 2), 40, 3, 0.8);
  Image<float> image(kSize, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const float leaf = leaves.at(column, row), clump = mass.at(column, row);
      image(column, row) =
          0.24f * std::clamp(1 + 0.45f * leaf + 0.3f * clump + 0.1f * leaf * std::abs(leaf), 0.12f, 3.0f);
    }
  }
  return Texture(image, TextureWrap::kRepeat);
}

}  // namespace ldso::simulation
