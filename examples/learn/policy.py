"""The learnt policy: one picture, where the hand is, and an instruction in; a chunk of actions out.

    words --embedding, GRU--> text ------------+- FiLM ----------+- queries
    picture --4 x 4 patches, convolutions------+--> features ----+--> maps --spatial softmax--> points --> places
    places, hand --> the next 4 actions

A point is the mean place of a map's softmax: it moves with what its map shows by fractions of a pixel, so some hundred
demonstrations teach where things are. Places are where the hand would hold the source as it lies now, and where it
would let it go. Nobody labelled them: the hand of the same demonstration went there later.
"""
import re

import torch
from torch import nn
from torch.nn import functional as F

CHUNK, HEIGHT, WIDTH = 4, 96, 128


def words_of(instruction):
    return re.findall(r"[a-z]+", instruction.lower())


def hand_of(state):
    """[n, 7] x y z roll pitch yaw openness, as exported and as served -> [n, 10].

    A hand that points down has a pitch near pi/2, where roll and yaw jump; two columns of its rotation
    Rz(yaw) Ry(pitch) Rx(roll) do not."""
    (sr, sp, sy), (cr, cp, cy) = state[:, 3:6].sin().T, state[:, 3:6].cos().T
    x = torch.stack([cy * cp, sy * cp, -sp], 1)
    y = torch.stack([cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr], 1)
    return torch.cat([state[:, :3], x, y, state[:, 6:]], 1)


class Learnt(nn.Module):
    def __init__(self, vocabulary, maps=32, channels=32):
        super().__init__()
        self.number = {word: i + 1 for i, word in enumerate(vocabulary)}  # 0: never read
        self.embedding = nn.Embedding(len(vocabulary) + 1, 32)
        self.reader = nn.GRU(32, 64, batch_first=True)
        self.stem = nn.Conv2d(48, channels, 3, padding=1)
        self.convolutions = nn.ModuleList([nn.Conv2d(channels, channels, 3, padding=d, dilation=d) for d in (1, 2)])
        self.film = nn.Linear(64, 2 * channels * len(self.convolutions))
        self.queries = nn.Linear(64, maps * channels)
        self.to_places = nn.Sequential(nn.Linear(2 * maps + 64, 128), nn.ReLU(), nn.Linear(128, 12))
        self.to_actions = nn.Sequential(nn.Linear(10 + 12 + 15, 256), nn.ReLU(), nn.Linear(256, 256), nn.ReLU(),
                                        nn.Linear(256, CHUNK * 7))
        grid = torch.meshgrid(torch.linspace(-1, 1, HEIGHT // 4), torch.linspace(-1, 1, WIDTH // 4), indexing="ij")
        self.register_buffer("grid", torch.stack(grid, -1).reshape(-1, 2))
        sizes = {"hand_mean": 10, "hand_std": 10, "place_mean": 12, "place_std": 12, "action_std": 7}
        for name, size in sizes.items():
            self.register_buffer(name, torch.ones(size))

    def numbers(self, instruction):
        return [self.number.get(word, 0) for word in words_of(instruction)] or [0]

    def read(self, sentences):
        """Lists of word numbers -> [n, 64], what the reader knows behind the last word."""
        lengths = torch.tensor([len(s) for s in sentences])
        padded = nn.utils.rnn.pad_sequence([torch.as_tensor(s) for s in sentences], batch_first=True)
        packed = nn.utils.rnn.pack_padded_sequence(self.embedding(padded), lengths, True, enforce_sorted=False)
        return self.reader(packed)[1][0]

    def places(self, pictures, text):
        """u8 [n, 96, 128, 3], [n, 64] -> [n, 12]: x y z and two columns of the rotation to hold the source, x y z to
        let it go; m, in the robot's base frame."""
        x = F.pixel_unshuffle(pictures.permute(0, 3, 1, 2).float() / 128 - 1, 4)
        x = F.relu(self.stem(x))
        for convolution, film in zip(self.convolutions, self.film(text).chunk(len(self.convolutions), 1)):
            gain, bias = film[:, :, None, None].chunk(2, 1)
            x = x + F.relu(convolution(x) * (1 + gain) + bias)
        maps = self.queries(text).reshape(len(x), -1, x.shape[1]) @ x.flatten(2)
        points = (maps.softmax(2) @ self.grid).flatten(1)
        return self.to_places(torch.cat([points, text], 1)) * self.place_std + self.place_mean

    def actions(self, places, hand):
        """[n, 12], [n, 10] -> [n, 4, 7], in multiples of `action_std`."""
        away = torch.cat([places[:, :3] - hand[:, :3], places[:, 9:] - hand[:, :3], places[:, 9:] - places[:, :3]], 1)
        turn = places[:, 3:9] - hand[:, 3:9]
        seen = [(hand - self.hand_mean) / self.hand_std, (places - self.place_mean) / self.place_std, away / 0.1,
                turn / 0.5]
        return self.to_actions(torch.cat(seen, 1)).reshape(-1, CHUNK, 7)

    @torch.no_grad()
    def act(self, pictures, states, instructions):
        """u8 [n, 96, 128, 3], [n, 7], n texts -> actions [n, 4, 7]: m, rotation vector, gripper -1 .. 1."""
        places = self.places(pictures, self.read([self.numbers(i) for i in instructions]))
        actions = self.actions(places, hand_of(states.float())) * self.action_std
        actions[..., 6].clamp_(-1, 1)
        return actions


def save(policy, path):
    torch.save({"vocabulary": list(policy.number), "weights": policy.state_dict()}, path)


def load(path):
    kept = torch.load(path, map_location="cpu")
    policy = Learnt(kept["vocabulary"])
    policy.load_state_dict(kept["weights"])
    return policy.eval()
