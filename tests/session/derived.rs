//! Results are fresh only for what they were computed from; jobs report, stop and fail without harm.

use dashpot::control::Cancelled;
use dashpot::session::derived::{Freshness, Node};
use dashpot::session::jobs::{Job, JobError};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::channel;
use std::time::Duration;

const LONG: Duration = Duration::from_secs(30);

#[test]
fn a_stale_result_is_never_fresh() {
    let mut node: Node<u64, u64, Cancelled> = Node::new("square");
    assert_eq!(node.get(&1), Freshness::Stale(None));
    node.update(&1, || (), |_| Ok(10));
    node.wait(LONG);
    assert_eq!(node.fresh(&1).as_deref(), Some(&10));
    assert_eq!(node.fresh(&2), None);
    assert_eq!(node.get(&2), Freshness::Stale(Some(Arc::new(10))));
    // The document moves on while the job of revision 2 runs: its late result does not count for revision 3.
    let (go, wait) = channel::<()>();
    node.update(
        &2,
        || (),
        move |_| {
            let _ = wait.recv_timeout(LONG);
            Ok(20)
        },
    );
    assert!(node.running().is_some());
    node.update(&3, || (), |_| Ok(30));
    let _ = go.send(());
    node.wait(LONG);
    assert_eq!(node.fresh(&3).as_deref(), Some(&30));
    assert_eq!(node.fresh(&2), None);
}

#[test]
fn cancelled_work_starts_again_only_when_asked() {
    let mut node: Node<u64, u64, Cancelled> = Node::new("endless");
    let endless = |control: &dashpot::control::Control| loop {
        control.check()?;
        std::thread::sleep(Duration::from_millis(1));
    };
    node.update(&1, || (), endless);
    node.cancel();
    node.update(&1, || (), |_| Ok(1));
    assert!(node.running().is_none());
    node.retry();
    node.update(&1, || (), |_| Ok(1));
    node.wait(LONG);
    assert_eq!(node.fresh(&1).as_deref(), Some(&1));
}

#[test]
fn dropping_a_job_cancels_it() {
    let (ended, end) = channel();
    let job = Job::start(
        "endless",
        (),
        || (),
        move |control| {
            while control.check().is_ok() {
                std::thread::sleep(Duration::from_millis(1));
            }
            ended.send(()).unwrap();
        },
    );
    drop(job.unwrap());
    end.recv_timeout(LONG).unwrap();
}

#[test]
fn a_job_reports_and_wakes() {
    let woken = Arc::new(AtomicBool::new(false));
    let (flag, (ready, wait)) = (woken.clone(), channel());
    let wake = move || {
        flag.store(true, Ordering::SeqCst);
        ready.send(()).unwrap();
    };
    let job = Job::start("half", 5, wake, |control| {
        control.report(0.5);
        std::thread::current().name().map(str::to_owned)
    });
    let job = job.unwrap();
    wait.recv_timeout(LONG).unwrap();
    assert!(woken.load(Ordering::SeqCst));
    assert_eq!(job.poll().unwrap().unwrap().as_deref(), Some("half"));
    assert!((job.progress() - 0.5).abs() < 1e-6);
    assert!(job.poll().is_none());
}

#[test]
fn a_panic_is_an_error_and_no_end() {
    // Past the panic hook: a backtrace read from a slow disk would take longer than any deadline.
    let job = Job::start("bad", (), || (), |_| -> u8 { std::panic::resume_unwind(Box::new("on purpose")) }).unwrap();
    let error = job.wait(LONG).unwrap().unwrap_err();
    assert!(matches!(error, JobError::Panicked { reason, .. } if reason == "on purpose"));
}
