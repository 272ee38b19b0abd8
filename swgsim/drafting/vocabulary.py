"""Words of the field in English and German and those of recorders and drives, in small letters without accents."""

from collections.abc import Mapping


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


# The quantity of a whole word, or of two words that belong together. Numbers with h are objects of drives (CiA 402).
WORDS: Mapping[str, frozenset[str]] = {
    "time": _words(
        "t time zeit timestamp stamp zeitstempel clock secs nsecs sec nanosec nsec elapsed uhrzeit datum date datetime "
        "x_value ts tijd"
    ),
    "angle": _words(
        "q pos position positions angle angles winkel drehwinkel winkelposition istposition phi theta qm thetam "
        "enc encoder drehgeber lage rotation 6064h"
    ),
    "speed": _words(
        "qd dq qdot dqdt vel velocity velocities speed speeds omega w wm dqm qdm omegam drehzahl geschwindigkeit "
        "istgeschwindigkeit winkelgeschwindigkeit n nist rpm thetadot phidot thetad 606ch"
    ),
    "torque": _words("torque torques trq tau drehmoment moment momente effort efforts m md mom nm"),
    "current": _words("current currents curr strom motorstrom i im iq i_q amps ampere cur 6077h 6078h"),
    "gauge": _words("strain dehnung dms dehnungsmessstreifen bridge brucke bruecke gauge sg"),
    "temperature": _words("temp temperature temperatur motortemperatur"),
    "acceleration": _words("acc accel acceleration beschleunigung qdd ddq qddot"),
    "voltage": _words("voltage spannung volt udc"),
    "counter": _words("seq sample samples index count counter nr no number row id idx cycle messwert"),
    "status": _words("status mode state error flag trigger frame name comment bemerkung fehler"),
}
# Parts of compound words, such as Motordrehzahl.
PARTS: Mapping[str, tuple[str, ...]] = {
    "time": ("zeit",),
    "angle": ("position", "winkel", "angle"),
    "speed": ("geschwindigkeit", "drehzahl", "velocity", "speed"),
    "torque": ("moment", "torque"),
    "current": ("strom", "current"),
    "gauge": ("strain", "dehnung", "brucke", "bridge"),
    "temperature": ("temperatur",),
    "acceleration": ("beschleunigung", "accel"),
}
# A value that was asked for, or the difference to it, not one that was measured.
SET = _words(
    "target soll sollwert desired des cmd command commanded ref reference setpoint demand demanded set goal following "
    "error 607ah 60ffh 6071h 6062h 606bh"
)
MODEL = _words("model modell rigid dynamics idyn gravity feedforward ff target")
MOTOR = _words("motor mot motorseitig rotor qm thetam wm dqm qdm omegam im")
INPUT = _words("in input antrieb eingang drive motor mot wg wavegenerator an ein fast")
OUTPUT = _words("out output abtrieb abtriebs ausgang load link last flange ab aus arm joint")
# Words of names that do not tell one joint from another.
COMMON = _words(
    "actual act ist is meas measured value val state states joints axis axes achse robot data log filtered raw"
)
# Behind these words stands the place of a channel, such as A, and no quantity.
CHANNEL = _words("channel kanal ch chan input")
