// An Acclaim skeleton with two legs, a trunk and arms in a T pose, which tests may modify, and a
// motion for it.
#pragma once
#include <string>

#include "files/bvh_text.h"

namespace gaitpad {

inline std::string acclaim_bone(const std::string& name, const std::string& direction,
                                const std::string& length, const std::string& more) {
  return "  begin\n    id 1\n    name " + name + "\n    direction " + direction + "\n    length " +
         length + "\n" + more + "  end\n";
}

// A skeleton in CMU's dialect: lengths in inches times 0.45, degrees, thighs' axes turned by 20
// degrees.
inline std::string acclaim_skeleton() {
  const std::string three =
      "    dof rx ry rz\n    limits (-160.0 20.0)\n           (-70.0 70.0)\n" +
      std::string("           (-60.0 70.0)\n");
  std::string text =
      "# AST/ASF file generated using VICON BodyLanguage\n:version 1.10\n:name VICON\n:units\n"
      "  mass 1.0\n  length 0.45\n  angle deg\n:documentation\n   free text: \"begin\"\n"
      ":root\n   order TX TY TZ RX RY RZ\n   axis XYZ\n   position 0 0 0\n   orientation 0 0 0\n"
      ":bonedata\n";
  for (const auto& [l, x] : {std::pair{"l", "1"}, {"r", "-1"}}) {
    const std::string side(l), sign(x[0] == '-' ? "-" : "");
    const std::string axis = "    axis 0 0 " + sign + "20 XYZ\n";
    text +=
        acclaim_bone(side + "hipjoint", std::string(x) + " -1 0", "2.4", "    axis 0 0 0 XYZ\n");
    text += acclaim_bone(side + "femur", "0 -1 0", "7.5", axis + three);
    text += acclaim_bone(side + "tibia", "0 -1 0", "7.4",
                         axis + "    dof rx\n    limits (-10.0 170.0)\n");
    text += acclaim_bone(side + "foot", "0 -1 2", "2.4",
                         "    axis -90 0 " + sign + "20 XYZ\n    dof rx rz\n");
    text += acclaim_bone(side + "toes", "0 0 1", "1.2",
                         "    axis -90 0 " + sign + "20 XYZ\n    dof rx\n");
  }
  text += acclaim_bone("thorax", "0 1 0", "6", "    axis 0 0 0 XYZ\n" + three);
  return text +
         ":hierarchy\n  begin\n    root lhipjoint rhipjoint thorax\n    lhipjoint lfemur\n"
         "    lfemur ltibia\n    ltibia lfoot\n    lfoot ltoes\n    rhipjoint rfemur\n"
         "    rfemur rtibia\n    rtibia rfoot\n    rfoot rtoes\n  end\n";
}

inline std::string acclaim_frame(int number, const std::string& root = "0 17 0 0 0 0") {
  return std::to_string(number) + "\nroot " + root +
         "\nthorax 1 2 3\nlfemur 30 0 0\nltibia 20\nlfoot 0 0\nltoes 0\nrfemur 0 0 0\nrtibia 0\n"
         "rfoot 0 0\nrtoes 0\n";
}

inline std::string acclaim_motion(int frames = 2) {
  std::string text = "#!OML:ASF F:\\VICON\\rory3.ASF\n:FULLY-SPECIFIED\n:DEGREES\n";
  for (int f = 1; f <= frames; ++f) text += acclaim_frame(f);
  return text;
}

}  // namespace gaitpad
