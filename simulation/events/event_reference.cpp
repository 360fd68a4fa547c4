#include "simulation/events/event_reference.hpp"

namespace holdfast::simulation {
namespace {

struct Row {
  const char* event;
  const char* lasts;
  const char* what;
};

const Row kRows[] = {
    {"`blind`", "2 s", "the LiDAR's clouds are empty"},
    {"`lidar_off`", "2 s", "no scan is a message"},
    {"`imu_off`", "2 s", "no IMU sample is a message"},
    {"`imu_bias_jump`", "at once", "both IMU biases jump and stay"},
    {"`kidnap`", "at once",
     "the body stands elsewhere on the route, 3 m or 45 degrees away at least, and the IMU feels "
     "nothing"},
    {"`kidnap` with a duration", "as long",
     "the LiDAR is covered, the robot stops, is lifted by up to 0.5 m, carried along the route "
     "to such a place within 3 m/s and 4 m/s^2, and stands there when the LiDAR is uncovered; "
     "the IMU feels all of it. The error of a duration that is too short says what is needed "
     "(about 4 s at 1.2 m/s)"},
    {"`clock_jump`", "for good",
     "the LiDAR's stamps step by 20 to 100 ms, forwards or back; with a duration they step back "
     "after it (see Clocks)"},
    {"`crowd`", "10 s",
     "up to 32 people walk with the robot and round it in rings of about 1.2 and 2.2 m, as far "
     "as there is room, and hide 60 to 70 % of what lies within 15 m when they are densest; the "
     "robot goes at 1.2 m/s at most. They come within the first quarter of it (2.5 s at most) "
     "and go in the last; before and after, whom nothing hides is in sight further off. They "
     "come and go where something hides them from the LiDAR or more than 25 m away, or, in rooms "
     "without such a place, through a wall 3 m from the robot or further, as if it had a door"},
};

}  // namespace

std::string event_reference() {
  std::string text =
      "# Events\n\n"
      "`--event NAME@T0[+DURATION]`, seconds from the start; may be given more than once.\n\n"
      "| event | lasts | what happens |\n|---|---|---|\n";
  for (const Row& row : kRows) {
    text += std::string("| ") + row.event + " | " + row.lasts + " | " + row.what + " |\n";
  }
  return text + "\n";
}

}  // namespace holdfast::simulation
