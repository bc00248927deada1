"""How a field of a machine file says where its value comes from."""

from __future__ import annotations

from typing import Any, Literal

import msgspec

Provenance = Literal["documented", "host", "inferred", "assumed", "design"]


def known(
    description: str,
    provenance: Provenance,
    confidence: str = "",
    source: str = "",
    *,
    acts: bool = True,
    **limits: Any,
) -> msgspec.Meta:
    """Meta of one field: what it is (with its unit), how sure we are, and the limits msgspec shall enforce.

    `confidence` is H, M or L for inferred and assumed values, else empty. `acts` is False for a value that is kept
    for a part of the unit that is not built: the ledger says so.
    """
    extra = {"provenance": provenance, "confidence": confidence, "source": source, "acts": acts}
    return msgspec.Meta(description=description, extra=extra, **limits)


class Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Common shape of all tables: immutable, keyword-only, unknown keys refused."""
