"""Held-out data that the response does not explain."""

from collections.abc import Iterator

from dalembert.findings import Finding
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.validation.explained import percent, record_shares


def unexplained_validation(optimum: Optimum) -> Iterator[Finding]:
    """Yield a finding for each record of which too little is explained, though noise is not the reason."""
    shares = () if optimum.validation is None else optimum.validation.explained
    for record, share in record_shares(shares).items():
        poor = [item for item in shares if item.record == record and item.poor]
        if not poor:
            continue
        worst = min(poor, key=lambda item: item.share)
        what = f"the held-out record {record!r}" if record else "the held-out samples"
        yield Finding(
            "validation-unexplained",
            "warning",
            {"record": record, "channel": worst.channel, "explained": share, "channel_explained": worst.share},
            f"The response explains {percent(share)} of the variation of {what}, "
            f"{percent(worst.share)} in {worst.channel!r}.",
            "The model does not predict this motion. Fit such records too, or look for what the model lacks.",
        )
