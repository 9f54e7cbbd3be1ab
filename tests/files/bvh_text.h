// Small BVH files for tests: a walker with legs of 40 + 40 units and feet on the floor.
#pragma once
#include <string>

namespace gaitpad {

struct WalkerText {
  std::string root = "Hips";
  std::string root_offset = "0 0 0";
  std::string root_channels = "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation";
  std::string left = "Left", right = "Right";  // prefixes of the joints' names
  std::string hip = "UpLeg", knee = "Leg", ankle = "Foot", toe = "ToeBase";
  std::string joint_channels = "3 Zrotation Xrotation Yrotation";
  std::string frames = "0 90 0 0 0 0";  // the root's numbers in the only frame

  std::string leg(const std::string& side, const std::string& x) const {
    const std::string c = "CHANNELS " + joint_channels + "\n";
    return "JOINT " + side + hip + "\n{\nOFFSET " + x + " -2 0\n" + c +  //
           "JOINT " + side + knee + "\n{\nOFFSET 0 -40 0\n" + c +        //
           "JOINT " + side + ankle + "\n{\nOFFSET 0 -40 0\n" + c +       //
           "JOINT " + side + toe + "\n{\nOFFSET 0 -8 12\n" + c +         //
           "End Site\n{\nOFFSET 0 0 6\n}\n}\n}\n}\n}\n";
  }
  std::string hierarchy() const {
    return "HIERARCHY\nROOT " + root + "\n{\nOFFSET " + root_offset + "\nCHANNELS " +
           root_channels + "\n" + leg(left, "10") + leg(right, "-10") + "}\n";
  }
  // A frame's line: the root's numbers, then zeros for the three channels of each of the eight
  // joints.
  std::string frame(const std::string& root_values) const {
    std::string line = root_values;
    for (int i = 0; i < 24; ++i) line += " 0";
    return line + "\n";
  }
  std::string text() const {
    return hierarchy() + "MOTION\nFrames: 1\nFrame Time: 0.01\n" + frame(frames);
  }
};

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace gaitpad
