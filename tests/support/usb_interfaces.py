"""USB devices as udev rules see them: ids, and class, subclass and protocol of each interface. Keyboards: Wooting's have
the interface of an Xbox 360 pad, PowerA's vendor number stands for any keyboard of a maker of pads; Razer and Logitech,
who make both, are listed pad by pad.
"""
KEYBOARD, MOUSE, PLAIN, XBOX_360, XBOX_ONE = "030101", "030102", "030000", "ff5d01", "ff47d0"

KEYBOARDS = [("31e3:1312", [XBOX_360, PLAIN, KEYBOARD, PLAIN]), ("20d6:ffff", [KEYBOARD, PLAIN]),
             ("1532:0221", [MOUSE, KEYBOARD, "030001"]), ("046d:c52b", [KEYBOARD, MOUSE, PLAIN])]
PADS = [("045e:028e", [XBOX_360, "ff5d03", "ff5d02", "fffd13"]), ("24c6:543a", [XBOX_360]), ("1209:0360", [XBOX_360]),
        ("045e:02ea", [XBOX_ONE, XBOX_ONE, XBOX_ONE]), ("054c:0ce6", ["010100", "010200", "010200", PLAIN]),
        ("057e:2009", [PLAIN]), ("20d6:a711", [PLAIN]), ("0f0d:00c1", [PLAIN])]
STEAM = ("28de:1142", [KEYBOARD, PLAIN, PLAIN, PLAIN, PLAIN])  # named by the rules, with its own keyboard
