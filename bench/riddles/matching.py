# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Whether an answer's effect shows what a hidden one does.

Each hidden effect acts alone in a twin of the riddle without noise: chi2 of the given model is then the square of
the effect's trace, in standard deviations, after projection on map and poses; chi2 of the fitted answer is what the
answer leaves of it. The cosine of both traces is the root of one less their ratio. So any channel and any formula
can be held against any other, by the command's own `compare` and `fit`.
"""
import math

from make_riddles import GROSS
from program import Refused, cut, effect_of, is_formula, model_text

SAME = 0.95  # cosine of traces that count as the same
SHARE = 0.2  # of a size that counts as right, or
SQUARES = {1: 9.0, 2: 11.8, 3: 14.2, 4: 16.3}  # as much as three standard errors of one coefficient, of two ... leave


class Matcher:
    def __init__(self, program, out, truth, scratch):
        self.program, self.truth, self.scratch = program, truth, scratch
        self.base = (out / "riddles" / truth["riddle"] / "model.toml").read_text()
        self.twins, self.fits, self.facts = {}, {}, {}

    def small(self, k):
        """The hidden effect, a gross one at a size at which traces are what they are to first order."""
        one = self.truth["effects"][k]
        if self.truth["kind"] != "gross":
            return one
        return {**one, "coefficients": [math.copysign(GROSS, c) for c in one["coefficients"]]}

    def twin(self, k):
        """The recording, and its chi2 under the given model."""
        if k not in self.twins:
            model, whole, shown = (self.scratch / f"{k}{end}" for end in (".toml", "-whole", "-shown"))
            model.write_text(model_text([self.small(k)], self.base))
            self.program.run("simulate", *self.truth["simulate"], "--effects", model, "--noise-free", "--out", whole)
            cut(whole, shown, self.truth["until_s"])
            self.twins[k] = shown, self.chi2("compare", shown, [])
        return self.twins[k]

    def chi2(self, command, twin, effects):
        return self.told(command, twin, effects)["chi2"]

    def told(self, command, twin, effects):
        model = self.scratch / "answer.toml"
        model.write_text(model_text(effects, self.base))
        return self.program.json(command, twin, "--model", model, "--gate", 0)

    def same_text(self, k, text):
        one = self.truth["effects"][k]
        return one["name"] == text or (is_formula(text) and self.plain(one["name"]) == self.plain(text))

    def plain(self, text):
        """Channel and shapes, of a catalogue name as the command knows it."""
        if text not in self.facts:
            effect = effect_of(text)
            if "channel" not in effect:
                try:
                    effect = self.program.json("effects", text)["effects"][0]
                except (Refused, KeyError, IndexError):
                    effect = {"channel": text, "shape": []}
            self.facts[text] = effect["channel"], [one.replace(" ", "") for one in effect["shape"]]
        return self.facts[text]

    def fit(self, k, text):
        """(cosine, chi2 left) of the answer's effect, fitted to the twin of hidden effect k."""
        if self.same_text(k, text):
            return 1.0, 0.0
        if (k, text) not in self.fits:
            twin, whole = self.twin(k)
            try:
                left = self.chi2("fit", twin, [effect_of(text)])
            except Refused:
                left = whole  # this recording does not show such an effect
            self.fits[k, text] = math.sqrt(max(0.0, 1.0 - left / whole)), left
        return self.fits[k, text]

    def shows(self, k, text):
        return self.fit(k, text)[0] >= SAME

    def any_shows(self, k, text, alike):
        """Whether an effect does, or one that looks like it (by a cosine of SAME as well)."""
        if self.shows(k, text):
            return True
        farthest = math.cos(2.0 * math.acos(SAME))  # of an effect one of whose look-alikes shows it
        return self.fit(k, text)[0] >= farthest and any(self.shows(k, one) for one in alike)

    def pairs(self, texts):
        """For each hidden effect the answer's that shows it best, none twice; None where none does."""
        found = [None] * len(self.truth["effects"])
        likely = sorted(((self.fit(k, text)[0], k, at) for k in range(len(found))
                         for at, text in enumerate(texts)), reverse=True)
        for cosine, k, at in likely:
            if cosine >= SAME and found[k] is None and at not in found:
                found[k] = at
        return found

    def together(self, texts):
        """Whether each hidden effect is shown by all of these at once: constants have more than one set of names."""
        for k in range(len(self.truth["effects"])):
            twin, whole = self.twin(k)
            try:
                left = self.chi2("fit", twin, [effect_of(text) for text in texts])
            except Refused:
                return False
            if left > (1.0 - SAME * SAME) * whole:
                return False
        return True

    def together_sized(self, answered):
        """Whether these leave no more of all hidden effects than sizes that are a fifth off would."""
        model, whole, shown = (self.scratch / f"all{end}" for end in (".toml", "-whole", "-shown"))
        model.write_text(model_text(self.truth["effects"], self.base))
        self.program.run("simulate", *self.truth["simulate"], "--effects", model, "--noise-free", "--out", whole)
        cut(whole, shown, self.truth["until_s"])
        try:
            return self.chi2("compare", shown, answered) <= SHARE * SHARE * self.chi2("compare", shown, [])
        except Refused:
            return False

    def same_channel(self, k, text):
        return self.plain(text)[0] == self.plain(self.truth["effects"][k]["name"])[0]

    def right_size(self, k, text, coefficients):
        """Within a fifth or three standard errors of the best size that the answer's form could have."""
        if not coefficients:
            return False
        true = self.truth["effects"][k]["coefficients"]
        if self.same_text(k, text) and len(coefficients) == len(true) == 1 and \
                abs(coefficients[0] - true[0]) <= SHARE * abs(true[0]):
            return True
        if self.truth["kind"] == "gross":
            return False  # beyond first order only the same constant has a size to compare
        twin, whole = self.twin(k)
        try:
            left = self.chi2("compare", twin, [effect_of(text, coefficients)])
        except Refused:
            return False
        return left - self.fit(k, text)[1] <= max(SQUARES.get(len(coefficients), 4.0 * len(coefficients)),
                                                  SHARE * SHARE * whole)
