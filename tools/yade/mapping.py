# SPDX-License-Identifier: GPL-2.0-or-later
"""Parameters of one contact in LIGGGHTS -> the two bodies' Yade materials that give the same contact.

The formulas are those of the table in doc/reference/yade.md, written from the thesis's equations and Yade's documentation.
"""
import math

PROPERTIES = {
    "vielto": [
        "youngsModulus",
        "stiffnessRatio",
        "frictionAngle",
        "normalDamping",
        "tangentialDamping",
        "rollingStiffnessFactor",
        "twistingStiffnessFactor",
        "rollingResistance",
        "twistingResistance",
    ],
    "cohfrict": [
        "youngsModulus",
        "stiffnessRatio",
        "frictionAngle",
        "alphaKr",
        "alphaKtw",
        "etaRoll",
        "etaTwist",
        "normalCohesion",
        "shearCohesion",
    ],
}
SETTINGS = {
    "vielto": ["springFactor", "limitForce", "slidingDashpot", "radiusLever", "rollingDashpot"],
    "cohfrict": ["bondNewContacts", "avoidRatcheting"],
}
WALL_RADIUS_FACTOR = {"box": 1, "facet": 2}  # what Yade takes for R_2/R_1


def harmonic(a, b):
    return 2 * a * b / (a + b) if a > 0 and b > 0 else 0.0


def sphere_mass(density, radius):
    return density * 4 / 3 * math.pi * radius**3


class Bodies:
    """Radii and effective mass of sphere 1 and body 2, and the spring between them."""

    def __init__(self, case):
        self.R1 = case["spheres"][0]["radius"]
        self.mass = sphere_mass(case["density"], self.R1)
        if case.get("wall"):
            self.R2 = WALL_RADIUS_FACTOR[case["wall"]] * self.R1
        else:
            self.R2 = case["spheres"][1]["radius"]
            m2 = sphere_mass(case["density"], self.R2)
            self.mass = self.mass * m2 / (self.mass + m2)
        a, b = case["materials"]
        self.k1, self.k2 = 2 * a["youngsModulus"] * self.R1, 2 * b["youngsModulus"] * self.R2
        factor = case["springFactor"] if case["model"] == "vielto" else 0.5
        self.normalSpring = factor * harmonic(self.k1, self.k2)  # what F_n rises by with the overlap


class Contact(Bodies):
    """Stiffnesses, dashpots and caps of ViElTo between sphere 1 and body 2."""

    def __init__(self, case):
        super().__init__(case)
        a, b = case["materials"]
        self.kn = harmonic(self.k1, self.k2)
        self.ks = harmonic(self.k1 * a["stiffnessRatio"], self.k2 * b["stiffnessRatio"])
        self.normalDashpot = (a["normalDamping"] + b["normalDamping"]) * math.sqrt(self.kn * self.mass)
        self.tangentialDashpot = (a["tangentialDamping"] + b["tangentialDamping"]) * math.sqrt(self.ks * self.mass)
        self.frictionAngle = math.radians((a["frictionAngle"] + b["frictionAngle"]) / 2)
        self.length = harmonic(self.R1, self.R2)
        self.rolling = min(a["rollingResistance"], b["rollingResistance"])
        self.twisting = min(a["twistingResistance"], b["twistingResistance"]) * math.tan(self.frictionAngle)


def yade_materials(case):
    """Keyword arguments of Yade's material for body 1 and body 2."""
    if case["model"] == "cohfrict":  # the same law: the same numbers, and Yade mixes them
        same = ("alphaKr", "alphaKtw", "etaRoll", "etaTwist", "normalCohesion", "shearCohesion")
        return [
            dict(
                {name: m[name] for name in same},
                density=case["density"],
                young=m["youngsModulus"],
                poisson=m["stiffnessRatio"],
                frictionAngle=math.radians(m["frictionAngle"]),
            )
            for m in case["materials"]
        ]
    c = Contact(case)
    common = {"density": case["density"], "frictionAngle": c.frictionAngle}  # Yade takes the smaller of the two
    if case["law"] == "ViscEl":
        # Yade's contact value is a b/(a + b): twice the wanted value for each body
        one = dict(common, kn=2 * c.normalSpring, ks=2 * c.ks, cn=2 * c.normalDashpot, cs=2 * c.tangentialDashpot)
        return [one, one]
    cn = case["springFactor"]
    betaKr = harmonic(*(m["rollingStiffnessFactor"] for m in case["materials"]))
    return [
        dict(
            common,
            young=2 * cn * m["youngsModulus"],
            poisson=m["stiffnessRatio"] / cn,
            alphaKr=betaKr * c.kn / c.ks,
            alphaKtw=m["twistingStiffnessFactor"],
            etaRoll=c.rolling * c.length / R,
            etaTwist=c.twisting * c.length / R,
        )
        for m, R in zip(case["materials"], (c.R1, c.R2))
    ]


def start(case):
    """Spheres with place, velocity, spin, load: about to touch, or pressed to the overlap that balances the load."""
    c = Bodies(case)
    overlap = -1e-9 * c.R1  # at 0 the one engine counts the contact as begun, the other does not
    if case.get("press"):
        load = -case["gravity"][2] * c.mass if case.get("wall") else case["force"]
        overlap = load / c.normalSpring
    spheres = []
    for i, s in enumerate(case["spheres"]):
        x = [0.0, 0.0, c.R1 - overlap] if case.get("wall") else [[c.R1 + c.R2 - overlap, 0.0, 0.0], [0.0] * 3][i]
        spheres.append(
            {
                "radius": s["radius"],
                "x": x,
                "v": s.get("v", [0, 0, 0]),
                "w": s.get("w", [0, 0, 0]),
                "force": [(-1 if i == 0 else 1) * case.get("force", 0), 0, 0],
            }
        )
    return spheres
