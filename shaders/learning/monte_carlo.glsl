// The rule monte_carlo: the path remembers its events and, when it has ended, teaches each of them what it found
// beyond. As if it had started there: emission met by the direction that was drawn counts in full, later emission
// with the weight that NEE leaves to it.
struct Lesson {
  uint entry;      // of the direction that was drawn here
  vec3 direct;     // direct light by NEE, reflected here
  vec3 weight;     // of what comes from that direction
  vec3 emission;   // met by the ray in that direction
  float share;     // of that emission in the path's own sum
};

Lesson lessons[MAX_LESSONS];
uint events = 0u;    // lessons with `direct`
uint arrivals = 0u;  // of these, those whose ray has met something or left the scene

void learn_arrival(uint bounce, vec3 emission, float share) {
  if (bounce == 0u) return;
  lessons[bounce - 1u].emission = emission;
  lessons[bounce - 1u].share = share;
  arrivals = bounce;
}

void learn_leaving(inout Path path, uint bounce, vec3 radiance, float weight) {
  learn_arrival(bounce, radiance, weight);
}

void learn_arriving(inout Path path, Event e, Departure next, uint bounce, vec3 emitted, float weight, bool scatters,
                    RandomKey key) {
  learn_arrival(bounce, emitted, weight);
}

void learn_scattering(inout Path path, uint bounce, vec3 direct, Departure next) {
  lessons[bounce].entry = next.direction.entry;
  lessons[bounce].direct = direct;
  lessons[bounce].weight = next.weight;
  events = bounce + 1u;
}

void learn_survival(uint bounce, float survival) {
  lessons[bounce].weight /= survival;
}

void learn_lesson(inout Path path, Taught taught) {}

// Backwards along the path: `beyond` is the radiance that leaves an event towards the one before, without the
// event's own emission.
void learn_path(inout Path path) {
  vec3 beyond = events > arrivals ? lessons[arrivals].direct : vec3(0.0);
  uint left = arrivals;
  bool more = left > 0u;
  do {
    if (more) {
      --left;
      Lesson lesson = lessons[left];
      learn(path.tally, lesson.entry, average(lesson.emission * (LEARNS == LEARNS_BEYOND_NEE ? lesson.share : 1.0) + beyond));
      beyond = lesson.direct + lesson.weight * (lesson.share * lesson.emission + beyond);
      more = left > 0u;
    }
  } while (more);
  loop_was_cut = loop_was_cut || left > 0u;
}
